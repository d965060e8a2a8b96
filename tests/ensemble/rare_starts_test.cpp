// Starts that few draws find: in long ensembles none fails by chance.
#include <gtest/gtest.h>

#include "carom/base/error.hpp"
#include "carom/ensemble/escape.hpp"
#include "carom/ensemble/sampler.hpp"
#include "carom/events/world.hpp"
#include "systems.hpp"

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
TEST(RareStarts, InASmallWell) {
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

TEST(RareStarts, OnALineThatMostlyLiesOutside) {
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

}  // namespace
}  // namespace carom
