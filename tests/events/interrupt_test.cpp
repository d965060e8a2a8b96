// A run that is interrupted in the middle of a group's step goes on as if it had not been.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "carom/events/world.hpp"
#include "carom/files/system_file.hpp"
#include "carom/starts/sampler.hpp"

namespace carom {
namespace {

LoadedSystem gas(const std::string& integrator) {
  return read_system(
      "[table]\nshape = \"circle\"\nradius = 1\n[interaction]\nkind = \"coulomb\"\nstrength = "
      "1e-12\n[particles]\ncount = 500\n"
      "speed = 1\n[initial]\nkind = \"uniform\"\n[integrator]\n" +
          integrator + "\n[run]\nt_max = 1\nsample = 1e-5\n",
      "gas");
}

struct Sampled : Observer {
  void sample(int, Time, const State& s) override { x.push_back(s.position.x); }
  std::vector<double> x;
};

struct Course {
  std::vector<State> end;
  std::vector<double> samples;
};

// Interrupted at each question of some.
Course run(const System& system, double until, int every) {
  World world(*system.table, system.dynamics);
  world.sample_every(system.run.sample);
  add_starts(world, Sampler(system), 0);
  Sampled observer;
  int questions = 0, interrupts = 0;
  const auto asked = [&] {
    return every > 0 && interrupts < 10 && ++questions % every == 0 && ++interrupts > 0;
  };
  for (int n = 0; n < 50; ++n) world.run_until(until, observer, asked);
  if (every > 0) {
    EXPECT_GT(interrupts, 0);
  }
  Course r;
  for (int i = 0; i < world.size(); ++i)
    EXPECT_EQ(world.fate(i), Fate::survived) << world.report(i);
  for (int i = 0; i < world.size(); ++i) r.end.push_back(world.state_at(i, Time(until)));
  r.samples = observer.x;
  return r;
}

TEST(Interrupt, WithinAStepChangesNoBit) {
  for (const char* integrator : {"scheme = \"blanes-moan-srkn11b\"\nstep = 2e-5",
                                 "scheme = \"velocity-verlet\"\nstep = 2e-6"}) {
    const LoadedSystem loaded = gas(integrator);
    const Course whole = run(loaded.system, 1e-4, 0), parts = run(loaded.system, 1e-4, 1);
    for (std::size_t i = 0; i < whole.end.size(); ++i) {
      EXPECT_EQ(whole.end[i].position.x, parts.end[i].position.x) << integrator << i;
      EXPECT_EQ(whole.end[i].velocity.y, parts.end[i].velocity.y) << integrator << i;
    }
    EXPECT_EQ(whole.samples, parts.samples) << integrator;
  }
}

}  // namespace
}  // namespace carom
