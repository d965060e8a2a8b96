// Crossings of a section line while particles form groups, leave them and meet regions of force.
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "carom/events/world.hpp"
#include "carom/files/system_file.hpp"
#include "carom/starts/sampler.hpp"

namespace carom {
namespace {

using geometry::Vector;

/// Keeps each particle's crossings, and on which side of the line it was at each sample.
class Sides : public Observer {
 public:
  Sides(const Surface& line, const Table& table) : line_(line), table_(table) {}
  void sample(int particle, Time t, const State& s) override {
    const Vector origin = table_.lattice ? table_.lattice->translation(s.cell) : Vector{};
    const double g = surface_function(line_, s.position + origin, s.velocity);
    seen_[particle].samples.push_back({t, g > 0.0});
  }
  void crossing(int particle, Time t, const State& s, int direction) override {
    EXPECT_NEAR(surface_function(line_, s.position, s.velocity), 0.0, 1e-9);
    seen_[particle].crossings.push_back({t, direction});
  }

  /// Between two samples the directions of the crossings add up to the change of the side.
  std::size_t compare() const {
    std::size_t changes = 0;
    for (const auto& [particle, seen] : seen_) {
      std::size_t next = 0;
      for (std::size_t i = 1; i < seen.samples.size(); ++i) {
        const auto& [before, was_left] = seen.samples[i - 1];
        const auto& [now, is_left] = seen.samples[i];
        int sum = 0;
        for (; next < seen.crossings.size() && seen.crossings[next].first <= now; ++next) {
          EXPECT_GE(seen.crossings[next].first, before) << "particle " << particle;
          sum += seen.crossings[next].second;
        }
        changes += was_left != is_left;
        EXPECT_EQ(sum, static_cast<int>(is_left) - static_cast<int>(was_left))
            << "particle " << particle << " from " << before.value() << " to " << now.value();
      }
      EXPECT_EQ(next, seen.crossings.size()) << "particle " << particle;
    }
    return changes;
  }

 private:
  struct Seen {
    std::vector<std::pair<Time, bool>> samples;
    std::vector<std::pair<Time, int>> crossings;
  };
  const Surface& line_;
  const Table& table_;
  std::map<int, Seen> seen_;
};

/// Returns how often particles were seen to change the side. `part`: the run is made in parts of
/// that length.
std::size_t compare(const std::string& text, double x, double until, double part) {
  const LoadedSystem loaded = read_system(text, "section");
  const System& system = loaded.system;
  Surface line;
  line.from = {x, 0.0};
  line.to = {x, 1.0};
  World world(*system.table, system.dynamics);
  const std::vector<State> starts = Sampler(system).draw_all(world, 0);
  for (std::size_t i = 0; i < starts.size(); ++i) world.add(system.particles[i], starts[i]);
  world.watch(&line);
  world.sample_every(0.003);
  Sides sides(line, *system.table);
  for (double t = part; t < until; t += part) world.run_until(t, sides);
  world.run_until(until, sides);
  for (int i = 0; i < world.size(); ++i) EXPECT_FALSE(world.finished(i)) << world.report(i);
  return sides.compare();
}

std::string system_of(const std::string& table, const std::string& forces, int count,
                      const std::string& field) {
  return table + forces + "[field]\nB = " + field +
         "\n[particles]\nspeed = 1\ncount = " + std::to_string(count) +
         "\n[initial]\nkind = \"uniform\"\n[integrator]\nstep = 0.0005\n[run]\nt_max = 10\n";
}

const char* const square = "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n";
const char* const plane = "[lattice]\nvectors = [[1, 0], [0, 1]]\n";
const char* const yukawa = "[interaction]\nkind = \"yukawa\"\nstrength = 0.01\nrange = 0.002\n";
const char* const bump =
    "[[potential]]\nkind = \"fermi\"\nradius = 0.1\nsoftness = 0.004\ncenter = [0.5, 0.5]\n";

TEST(SectionWatch, GroupsThatFormAndSplitTellEveryCrossingOnce) {
  std::size_t changes = 0;
  for (const char* table : {square, plane})
    for (const char* field : {"0", "1.5"})
      for (const double part : {10.0, 0.0237})
        changes += compare(system_of(table, yukawa, 6, field), 0.41, 4.0, part);
  EXPECT_GT(changes, 30u);
}

TEST(SectionWatch, RegionsOfForceTellEveryCrossingOnce) {
  std::size_t changes = 0;
  for (const char* field : {"0", "1.5"})
    for (const double part : {10.0, 0.0237})
      changes += compare(system_of(square, bump, 1, field), 0.41, 20.0, part);
  EXPECT_GT(changes, 30u);
}

TEST(SectionWatch, RegionsOfForceAndGroupsTellEveryCrossingOnce) {
  std::size_t changes = 0;
  for (const char* field : {"0", "1.5"})
    for (const double part : {10.0, 0.0571})
      changes += compare(system_of(square, std::string(bump) + yukawa, 5, field), 0.41, 4.0, part);
  EXPECT_GT(changes, 30u);
}

}  // namespace
}  // namespace carom
