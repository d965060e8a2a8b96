// Starts that few draws find: in long ensembles none fails by chance.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "analyses/systems.hpp"
#include "carom/analyses/diffusion.hpp"
#include "carom/analyses/escape.hpp"
#include "carom/analyses/section.hpp"
#include "carom/analyses/splitting.hpp"
#include "carom/base/error.hpp"
#include "carom/events/world.hpp"
#include "carom/starts/sampler.hpp"

namespace carom {
namespace {

void draw_many(const std::string& toml, std::uint64_t trajectories) {
  const System system = make_system(toml);
  const World world(*system.table);
  const Sampler sampler(system);
  ASSERT_NO_THROW(check_start(system));
  for (std::uint64_t k = 0; k < trajectories; ++k) ASSERT_NO_THROW(sampler.draw(world, k, 0)) << k;
}

// With the limit of the first, one in twenty of the others would fail.
TEST(RareStarts, StartsInASmallWellAreFound) {
  draw_many(R"(
[table]
shape = "rectangle"
width = 100
height = 100
[particles]
energy = 0.0477
[initial]
kind = "uniform"
[[potential]]
kind = "harmonic"
omega = 1
center = [50, 50]
[integrator]
step = 0.01
)",
            200);
}

TEST(RareStarts, StartsOnALineMostlyOutsideAreFound) {
  draw_many(R"(
[table]
shape = "rectangle"
width = 1
height = 1
[initial]
kind = "line"
from = [0.5, 0.5]
to = [5000.5, 0.5]
angle = 0.3
)",
            200);
}

TEST(RareStarts, AreRefusedAtOnceWhereThereAreNone) {
  const System system = make_system(R"(
[table]
shape = "rectangle"
width = 1
height = 1
[particles]
energy = 1
[initial]
kind = "uniform"
[[potential]]
kind = "linear"
force = [0, 0]
[[potential]]
kind = "expression"
expression = "2 + x*x"
[integrator]
step = 0.01
)");
  EscapeOptions second_half;
  second_half.part = {500, 1000};
  EXPECT_THROW(run_escape(system, second_half), InputError);
}

// Of the draws one in 10^4 lies in the table, and of those hardly one below the energy: to know
// that there is no start takes minutes, and hours where there must be one.
const char* const hardly_any = R"(
[table]
shape = "rectangle"
width = 1
height = 1
[particles]
energy = 1e-9
[initial]
kind = "rectangle"
min = [0, 0]
max = [100, 100]
[[potential]]
kind = "harmonic"
omega = 1
center = [0.5, 0.5]
[integrator]
step = 0.01
[run]
t_max = 5
trajectories = 100
)";

TEST(RareStarts, TheSearchCanBeInterrupted) {
  const System system = make_system(hardly_any);
  const System free = make_system(
      "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n[initial]\nkind = \"rectangle\"\n"
      "min = [0, 0]\nmax = [10000, 10000]\n[run]\nt_max = 5\ntrajectories = 100\n");
  std::atomic<bool> stop{false};
  const auto interrupted = [&](const auto& run) {
    stop = false;
    std::thread later([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      stop = true;
    });
    run();  // would take hours
    later.join();
  };
  interrupted([&] {
    EscapeOptions options;
    options.interrupted = &stop;
    const EscapeResult result = run_escape(system, options);
    EXPECT_FALSE(result.complete);
    EXPECT_EQ(result.counts.trajectories, 0u);
  });
  interrupted([&] {
    DiffusionOptions options;
    options.interrupted = &stop;
    EXPECT_FALSE(run_diffusion(system, options).complete);
  });
  interrupted([&] {
    SectionOptions options;
    options.interrupted = &stop;
    EXPECT_FALSE(run_section(system, options).complete);
  });
  // The first trajectory has a limit, later ones have a thousand times as long.
  for (const System* one : {&system, &free})
    interrupted([&] {
      const World world(*one->table, one->dynamics);
      EXPECT_THROW(Sampler(*one, &stop).draw(world, 1, 0), SamplingStopped);
    });
}

TEST(RareStarts, TheSearchStopsOnEveryThread) {
  std::atomic<bool> stop{false};
  SplittingPlan plan;
  plan.levels = {1, 2};
  plan.population = 1'000'000;
  plan.repetitions = 2;
  SplittingOptions options;
  options.interrupted = &stop;
  const System free = make_system(
      "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n[initial]\nkind = \"rectangle\"\n"
      "min = [0, 0]\nmax = [100, 100]\n[run]\nt_max = 5\ntrajectories = 100\n");
  std::thread later([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    stop = true;
  });
  EXPECT_FALSE(run_splitting(free, plan, options).complete);
  later.join();
}

}  // namespace
}  // namespace carom
