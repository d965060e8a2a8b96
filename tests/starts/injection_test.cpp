// Particles that enter through a hole during a run: when, where, in which direction, and what is
// counted.
#include "carom/starts/injection.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "analyses/escape/records.hpp"
#include "analyses/systems.hpp"
#include "carom/analyses/diffusion.hpp"
#include "carom/analyses/escape.hpp"
#include "carom/analyses/run.hpp"
#include "carom/analyses/section.hpp"
#include "carom/base/error.hpp"
#include "carom/events/world.hpp"
#include "carom/geometry/curve_frame.hpp"

namespace carom {
namespace {

using geometry::Vector;

System with(const std::string& injections, const std::string& run, const char* field = "0") {
  return make_system(
      "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n"
      "[[table.hole]]\nname = \"door\"\nwall = \"bottom\"\ncenter = 0.4\nwidth = 0.3\n"
      "[[table.hole]]\nname = \"window\"\nwall = \"top\"\ncenter = 0.5\nwidth = 0.1\n"
      "[field]\nB = " +
      std::string(field) + "\n[particles]\ncount = 2\nspeed = 1.5\n" + injections + "[run]\n" +
      run);
}

struct EndTimes : Observer {
  void end(const EndEvent& event) override { times[event.particle] = event.time.value(); }
  std::map<int, double> times;
};

struct Trace : Observer {
  void sample(int particle, Time time, const State& state) override {
    if (particle >= static_cast<int>(first.size()))
      first.resize(static_cast<std::size_t>(particle) + 1, -1.0);
    double& t = first[static_cast<std::size_t>(particle)];
    if (t < 0.0) t = time.value();
    inside = inside && state.position.y >= 0.0;
  }
  std::vector<double> first;
  bool inside = true;
};

TEST(Injection, HappensAtTheTimesGiven) {
  const System system = with(
      "[[injection]]\nhole = \"door\"\ntimes = [0, 0.1, 3.25, 10]\n"
      "[[injection]]\nhole = \"window\"\ntimes = [2]\nspeed = 0.25\n",
      "t_max = 10\n");
  const double times[] = {0.0, 0.1, 3.25, 10.0, 2.0};
  const std::vector<InjectedParticle> drawn = Injector(system).draw(7);
  ASSERT_EQ(drawn.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(drawn[i].state.time, Time(times[i]));
    EXPECT_NEAR(std::sqrt(dot(drawn[i].state.velocity, drawn[i].state.velocity)),
                i < 4 ? 1.5 : 0.25, 1e-15);
  }
}

// Until it enters a particle is not sampled; afterwards it moves from where it entered.
TEST(Injection, RunsFollowWhatEnters) {
  System system = with("[[injection]]\nhole = \"door\"\ntimes = [0.1, 0.35]\n",
                       "t_max = 0.45\nsample = 0.125\n");
  const std::vector<InjectedParticle> drawn = Injector(system).draw(0);
  Trace trace;
  const SingleRunResult result = run_single(system, trace);
  ASSERT_EQ(result.particles.size(), 4u);
  ASSERT_EQ(trace.first.size(), 4u);
  EXPECT_EQ(trace.first[1], 0.0);
  EXPECT_EQ(trace.first[2], 0.125);
  EXPECT_EQ(trace.first[3], 0.375);
  EXPECT_TRUE(trace.inside);
  const RunEnd& last = result.particles[3];
  ASSERT_EQ(last.progress.hits, 0u);  // it moves by 0.15
  const Vector moved = Vector{last.x, last.y} - drawn[1].state.position;
  EXPECT_NEAR(moved.x, 0.1 * drawn[1].state.velocity.x, 1e-15);
  EXPECT_NEAR(moved.y, 0.1 * drawn[1].state.velocity.y, 1e-15);
}

TEST(Injection, StartsInTheHoleByTheCosineLaw) {
  const System system = with("[[injection]]\nhole = \"door\"\nrate = 20\n", "t_max = 1000\n");
  const std::vector<InjectedParticle> drawn = Injector(system).draw(0);
  const auto n = static_cast<double>(drawn.size());
  ASSERT_GT(n, 19000.0);
  double x = 0.0, xx = 0.0, sine = 0.0, sines = 0.0;
  const int wall = system.table->wall_index("bottom");
  for (const InjectedParticle& one : drawn) {
    const State& s = one.state;
    ASSERT_EQ(s.wall, wall);
    ASSERT_GE(s.position.x, 0.25);
    ASSERT_LE(s.position.x, 0.55);
    ASSERT_GT(s.velocity.y, 0.0);
    const double at = (s.position.x - 0.4) / 0.3, along = s.velocity.x / 1.5;
    x += at / n;
    xx += at * at / n;
    sine += along / n;
    sines += along * along / n;
  }
  // Position and tangential velocity are uniform: variances 1/12 and 1/3. Five standard deviations.
  EXPECT_NEAR(x, 0.0, 5 * std::sqrt(1.0 / 12 / n));
  EXPECT_NEAR(xx, 1.0 / 12, 5 * std::sqrt(1.0 / 180 / n));
  EXPECT_NEAR(sine, 0.0, 5 * std::sqrt(1.0 / 3 / n));
  EXPECT_NEAR(sines, 1.0 / 3, 5 * std::sqrt(4.0 / 45 / n));
}

// Poisson: mean and variance of the number are equal, for seeds and for trajectories.
TEST(Injection, NumbersAreThoseOfAPoissonProcess) {
  System system = with("[[injection]]\nhole = \"door\"\nrate = 0.7\n", "t_max = 10\n");
  constexpr int draws = 4000;
  for (const bool seeds : {true, false}) {
    double sum = 0.0, squares = 0.0, late = 0.0;
    for (int i = 0; i < draws; ++i) {
      if (seeds) system.run.seed = static_cast<std::uint64_t>(i);
      const auto drawn = Injector(system).draw(seeds ? 0 : static_cast<std::uint64_t>(i));
      const auto k = static_cast<double>(drawn.size());
      sum += k;
      squares += k * k;
      for (const InjectedParticle& one : drawn) {
        EXPECT_LT(one.state.time.value(), 10.0);
        late += one.state.time.value() > 7.5;
      }
    }
    const double mean = sum / draws, variance = squares / draws - mean * mean;
    RecordProperty(seeds ? "mean_of_seeds" : "mean_of_trajectories", std::to_string(mean));
    RecordProperty(seeds ? "variance_of_seeds" : "variance_of_trajectories",
                   std::to_string(variance));
    EXPECT_NEAR(mean, 7.0, 5 * std::sqrt(7.0 / draws));
    EXPECT_NEAR(variance, 7.0, 5 * std::sqrt((7.0 + 2 * 49.0) / draws));
    EXPECT_NEAR(late / draws, 1.75, 5 * std::sqrt(1.75 / draws));
  }
}

TEST(Injection, EntriesDoNotDisturbEachOther) {
  const std::string one = "[[injection]]\nhole = \"window\"\nrate = 1\n";
  const System alone = with("[[injection]]\nhole = \"door\"\nrate = 2\n", "t_max = 10\n");
  const System both = with("[[injection]]\nhole = \"door\"\nrate = 2\n" + one, "t_max = 10\n");
  const auto few = Injector(alone).draw(3), many = Injector(both).draw(3);
  ASSERT_LT(few.size(), many.size());
  for (std::size_t i = 0; i < few.size(); ++i) {
    EXPECT_EQ(few[i].state.time, many[i].state.time);
    EXPECT_EQ(few[i].state.velocity, many[i].state.velocity);
  }
  // Those of the start stay what they are.
  const System empty = with("", "t_max = 10\n");
  Observer observer;
  const SingleRunResult with_others = run_single(both, observer),
                        without = run_single(empty, observer);
  for (std::size_t p = 0; p < 2; ++p) {
    EXPECT_EQ(with_others.particles[p].x, without.particles[p].x);
    EXPECT_EQ(with_others.particles[p].progress.hits, without.particles[p].progress.hits);
  }
}

// It starts on the wall inside the hole. That is no escape; in a field it may come back before
// anything else.
TEST(Injection, EnteringIsNotEscaping) {
  for (const char* field : {"0", "2", "-40"}) {
    const System system = with("[[injection]]\nhole = \"door\"\nrate = 1\n",
                               "t_max = 40\ntrajectories = 100\n", field);
    int back = 0, injected = 0;
    for (std::uint64_t trajectory = 0; trajectory < 20; ++trajectory) {
      World world(*system.table);
      const auto drawn = Injector(system).add(world, trajectory);
      EndTimes ends;
      world.run_until(40.0, ends);
      for (int i = 0; i < world.size(); ++i) {
        ++injected;
        const double entry = drawn[static_cast<std::size_t>(i)].state.time.value();
        EXPECT_NE(world.fate(i), Fate::lost);
        EXPECT_NE(world.fate(i), Fate::singular);
        if (world.fate(i) != Fate::escaped) continue;
        // Without a field the nearest other wall is 0.25 away.
        EXPECT_GT(ends.times.at(i), std::string(field) == "0" ? entry + 0.2 / 1.5 : entry);
        back += world.hole(i) == system.table->hole_index("door");
      }
    }
    EXPECT_GT(injected, 700);
    EXPECT_GT(back, 0) << field;
  }
}

TEST(Injection, EnsemblesCountAllAndDoNotDependOnThreads) {
  const System system = with(
      "[[injection]]\nhole = \"door\"\nrate = 0.3\n[[injection]]\nhole = \"window\"\ntimes = [1, "
      "2]\n",
      "t_max = 20\ntrajectories = 300\n", "1");
  std::size_t expected = 0;
  for (std::uint64_t t = 0; t < 300; ++t) expected += 2 + injected_count(system, t);
  std::vector<TrajectoryRecord> records;
  EscapeOptions options;
  options.threads = 1;
  const EscapeResult one = run_escape(system, options, records);
  EscapeOptions three;
  three.threads = 3;
  three.block = 7;
  const EscapeResult other = run_escape(system, three);
  EXPECT_EQ(one.counts.trajectories, expected);
  EXPECT_EQ(one.counts.lost + one.counts.singular, 0u);
  EXPECT_EQ(one.digest, other.digest);
  EXPECT_EQ(one.counts.escaped, other.counts.escaped);
  ASSERT_EQ(records.size(), expected);
  for (std::size_t i = 1; i < records.size(); ++i)
    EXPECT_LT(records[i - 1].index, records[i].index);
  // The last two of a trajectory come through the window, downwards.
  EXPECT_EQ(records.back().y, 1.0);
  EXPECT_LT(records.back().vy, 0.0);
  System reseeded = system;
  reseeded.run.seed = 2;
  EXPECT_NE(run_escape(reseeded, three).digest, one.digest);
}

TEST(Injection, AHoleAcrossTheStartOfACircleIsWhole) {
  const System system = make_system(
      "[table]\nshape = \"circle\"\nradius = 1\n[[table.hole]]\nname = \"gate\"\nwall = "
      "\"circle\"\ncenter = 0\n"
      "width = 0.5\n[[injection]]\nhole = \"gate\"\nrate = 10\n[run]\nt_max = 100\n");
  int above = 0, below = 0;
  for (const InjectedParticle& one : Injector(system).draw(0)) {
    const Vector x = one.state.position;
    EXPECT_LE(std::fabs(std::asin(x.y)), 0.25 + 1e-12);
    EXPECT_LT(dot(x, one.state.velocity), 0.0);
    (x.y > 0.0 ? above : below) += 1;
  }
  EXPECT_NEAR(above, below, 5 * std::sqrt(1000.0));
}

TEST(Injection, IsRefusedWhereItIsNotKnown) {
  const System system =
      with("[[injection]]\nhole = \"door\"\ntimes = [1]\n", "t_max = 2\ntimes = [1, 2]\n");
  Observer silent;
  SingleRunOptions resumed;
  resumed.resume.resize(3);
  EXPECT_THROW(run_single(system, silent, resumed), InputError);
  System endless = system;
  endless.run.t_max = no_last_time;
  EXPECT_THROW(run_single(endless, silent), InputError);
  EXPECT_THROW(run_diffusion(system, {}), InputError);
  EXPECT_THROW(run_section(system, {}), InputError);
}

}  // namespace
}  // namespace carom
