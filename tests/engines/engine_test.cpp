// Every engine tells a listener the same, bit for bit.
#include "carom/engines/engine.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "analyses/systems.hpp"
#include "carom/base/exact_sum.hpp"
#include "carom/files/system_file.hpp"

namespace carom {
namespace {

/// The mean of x over all hits: all that an analysis needs to be.
class MeanPosition : public Listener {
 public:
  void hit(const Trajectory&, int, const State& state, std::uint64_t) override {
    sum_.add(state.position.x);
    ++hits_;
  }
  void end(const Trajectory&, const TrajectoryEnd& end) override {
    for (const ParticleEnd& p : end.particles) counted_ += p.hits;
  }
  double mean() const { return sum_.value() / static_cast<double>(hits_); }
  std::uint64_t hits() const { return hits_; }
  std::uint64_t counted() const { return counted_; }

 private:
  ExactSum sum_;
  std::uint64_t hits_ = 0, counted_ = 0;
};

template <class Analysis>
Analysis flown(const System& system, EngineOptions options, Analysis analysis = {}) {
  const Sampler sampler(system);
  DrawnStarts starts(sampler, TrajectoryRange{0, system.run.trajectories});
  options.t_end = system.run.t_max;
  EXPECT_TRUE(make_engine(system, options)->run(starts, analysis));
  return analysis;
}

std::vector<System> systems() {
  std::vector<System> all;
  for (const char* name : {"stadium", "magnetic-square", "sinai", "three-disc", "mushroom"}) {
    SystemOverrides overrides;
    overrides.set = {{"run.t_max", "40"}, {"run.trajectories", "150"}};
    all.push_back(load_system(name, overrides).system);
  }
  all.push_back(make_system(R"(
[table]
shape = "stadium"
half_length = 0.5
radius = 0.5
[[table.hole]]
wall = "top"
center = 0.5
width = 0.05
[[potential]]
kind = "harmonic"
omega = 1.3
[integrator]
step = 0.05
[particles]
speed = 1.5
[initial]
kind = "uniform"
[run]
t_max = 20
trajectories = 150
)"));
  return all;
}

TEST(Engines, GiveAListenerTheSameHits) {
  for (const System& system : systems()) {
    EXPECT_EQ(why_one_by_one(system), "") << system.name;
    EngineOptions options{.hits = true, .lanes = {}};
    const auto expected = flown<MeanPosition>(system, options);
    EXPECT_GT(expected.hits(), 10u) << system.name;
    for (const InstructionSet set : available_instruction_sets()) {
      options.lanes = set;
      const auto mean = flown<MeanPosition>(system, options);
      EXPECT_EQ(mean.mean(), expected.mean()) << system.name << ' ' << name_of(set);
      EXPECT_EQ(mean.hits(), expected.hits()) << system.name << ' ' << name_of(set);
      EXPECT_EQ(mean.counted(), expected.counted()) << system.name << ' ' << name_of(set);
    }
  }
}

/// Everything that a listener learns, by trajectory.
class Log : public Listener {
 public:
  void begin(const Trajectory& t) override { note(t, t.starts.front()); }
  void hit(const Trajectory& t, int, const State& s, std::uint64_t hits) override {
    note(t, s);
    lines[t.number].back() +=
        ' ' + std::to_string(s.wall) + ' ' + std::to_string(s.u) + ' ' + std::to_string(hits);
    ++hits_[t.number];
  }
  void sample(const Trajectory& t, int, std::size_t number, const State& s) override {
    note(t, s);
    lines[t.number].back() += " sample " + std::to_string(number);
  }
  bool stop(const Trajectory& t) override { return hits_[t.number] >= most; }
  void end(const Trajectory& t, const TrajectoryEnd& end) override {
    const ParticleEnd& p = end.particles.front();
    note(t, p.state);
    lines[t.number].back() += " end " + std::to_string(static_cast<int>(p.fate)) + ' ' +
                              std::to_string(p.hits) + ' ' + std::to_string(p.last_wall) + ' ' +
                              std::to_string(p.hole);
  }
  std::map<std::uint64_t, std::vector<std::string>> lines;
  std::uint64_t most = 1000000;

 private:
  void note(const Trajectory& t, const State& s) {
    char text[200];
    std::snprintf(text, sizeof text, "%a %a %a %a %a %lld %lld", s.position.x, s.position.y,
                  s.velocity.x, s.velocity.y, s.time.value(), static_cast<long long>(s.cell.first),
                  static_cast<long long>(s.cell.second));
    lines[t.number].push_back(text);
  }
  std::map<std::uint64_t, std::uint64_t> hits_;
};

TEST(Engines, TellEachTrajectoryInTheOrderOfItsEvents) {
  for (const System& system : systems())
    for (const std::uint64_t most : {std::uint64_t{7}, std::uint64_t{1000000}}) {
      EngineOptions options{.times = {0.0, 0.5, 3.0, 3.25, 11.0}, .hits = true, .lanes = {}};
      Log log;
      log.most = most;
      const auto expected = flown(system, options, log).lines;
      EXPECT_EQ(expected.size(), system.run.trajectories);
      for (const InstructionSet set : available_instruction_sets()) {
        options.lanes = set;
        const auto lines = flown(system, options, log).lines;
        for (const auto& [number, events] : expected)
          ASSERT_EQ(lines.at(number), events) << system.name << ' ' << number;
      }
    }
}

TEST(Engines, SayWhyTrajectoriesFlyOneByOne) {
  const System stadium = load_system("stadium").system;
  EXPECT_EQ(why_one_by_one(stadium), "");
  EXPECT_NE(why_one_by_one(stadium, {.surface = &stadium.section.surface}), "");
  EXPECT_NE(why_one_by_one(load_system("coulomb-circle").system), "");
  EXPECT_NE(why_one_by_one(load_system("soft-lorentz").system, {.energy = true}), "");
}

// A trajectory that is under way when the engine is stopped has no end.
TEST(Engines, StopWhenTheyAreAskedTo) {
  System system = load_system("stadium").system;
  system.run.t_max = 1e9;
  system.table = std::make_shared<const Table>(*load_system("magnetic-square").system.table);
  for (const std::optional<InstructionSet> lanes :
       {std::optional<InstructionSet>(), std::optional(widest_instruction_set())}) {
    const Sampler sampler(system);
    DrawnStarts starts(sampler, TrajectoryRange{0, 1000000});
    MeanPosition analysis;
    int asked = 0;
    EXPECT_FALSE(make_engine(system, {.t_end = 1e9, .lanes = lanes})->run(starts, analysis, [&] {
      return ++asked > 20;
    }));
  }
}

}  // namespace
}  // namespace carom
