// Long runs in lanes: every particle makes all its hits, or ends where a limit does not exist.
#include <gtest/gtest.h>

#include <algorithm>
#include <carom/carom.hpp>
#include <cstdlib>
#include <string>
#include <vector>

#include "carom/events/world.hpp"
#include "carom/lanes/free_lanes.hpp"
#include "random_tables.hpp"

namespace carom {
namespace {

struct Tabled {
  const char* name;
  const char* text;
};
void PrintTo(const Tabled& tabled, std::ostream* out) { *out << tabled.name; }

class LongRunsInLanes : public testing::TestWithParam<Tabled> {};

TEST_P(LongRunsInLanes, LoseNoParticle) {
  constexpr std::uint64_t hits_each = 10'000;
  const auto trajectories =
      static_cast<std::uint64_t>(tests::cases(100, 100'000));  // 10^6 hits, or 10^9
  const std::string text = std::string(GetParam().text) +
                           "[particles]\nspeed = 1\n[initial]\nkind = \"boundary\"\n"
                           "[run]\nt_max = 1e9\ncollisions = 10000\ntrajectories = 1\n";
  const System system = read_system(text, GetParam().name).system;
  World world(*system.table);
  const Sampler sampler(system);
  ASSERT_EQ(FreeLanes::hindrance(*system.table, system.particles), "");
  FreeLanes lanes(*system.table, system.particles, widest_instruction_set());
  lanes.limit_hits(hits_each);
  std::uint64_t next = 0, capped = 0, singular = 0, pinned = 0;
  lanes.run_until(
      1e300,
      [&](LaneStart& start) {
        if (next == trajectories) return false;
        start = {};
        start.tag = next;
        start.particle = system.particles[0];
        start.state = sampler.draw_all(world, next++)[0];
        return true;
      },
      [&](const LaneEnd& end) {
        capped += end.fate == Fate::capped;
        singular += end.fate == Fate::singular;
        pinned += end.fate == Fate::pinned;
        EXPECT_NE(end.fate, Fate::lost) << end.report;
        if (end.fate == Fate::capped) {
          EXPECT_EQ(end.hits, hits_each);
        }
      });
  EXPECT_EQ(capped + singular + pinned, trajectories);
  EXPECT_GT(capped, trajectories / 2);
  const LaneEffort& effort = lanes.effort();
  EXPECT_LT(static_cast<double>(effort.scalar), 1e-3 * static_cast<double>(effort.hits));
  RecordProperty("hits", std::to_string(effort.hits));
  std::printf("%s: %llu hits, %llu by the scalar engine, %llu singular, lost none\n",
              GetParam().name, static_cast<unsigned long long>(effort.hits),
              static_cast<unsigned long long>(effort.scalar),
              static_cast<unsigned long long>(singular));
}

// Cells of hits are counted in words of 32 bits, which are emptied after many sweeps: more than the
// halves of this run have, in the soak.
TEST(LongRunsOnLattices, EndInTheSameCellAtOnceAndByHalves) {
  const System system = read_system(
                            "[table]\nshape = \"sinai\"\nside = 1\nradius = \"1/4\"\ntorus = "
                            "true\n[particles]\nspeed = 1\n[initial]\nkind = \"boundary\"\n"
                            "[run]\nt_max = 1\ntrajectories = 1\n",
                            "torus")
                            .system;
  const auto hits = static_cast<std::uint64_t>(tests::cases(2000, 10'000'000));
  World world(*system.table);
  const Sampler sampler(system);
  std::vector<LaneStart> at_once(64);
  for (std::uint64_t i = 0; i < at_once.size(); ++i) {
    at_once[i].particle = system.particles[0];
    at_once[i].state = sampler.draw_all(world, i)[0];
  }
  std::vector<LaneStart> by_halves = at_once;
  FreeLanes lanes(*system.table, system.particles, widest_instruction_set());
  const auto fly = [&](std::vector<LaneStart>& starts, std::uint64_t limit) {
    std::size_t given = 0;
    lanes.limit_hits(limit);
    lanes.run_until(
        1e300,
        [&](LaneStart& start) {
          if (given == starts.size()) return false;
          start = starts[given];
          start.tag = given++;
          return true;
        },
        [&](const LaneEnd& end) {
          starts[end.tag].state = end.state, starts[end.tag].hits = end.hits;
        });
  };
  fly(at_once, hits);
  fly(by_halves, hits / 2);
  fly(by_halves, hits);
  std::int64_t farthest = 0;
  for (std::size_t i = 0; i < at_once.size(); ++i) {
    const State &one = at_once[i].state, &other = by_halves[i].state;
    EXPECT_EQ(one.cell, other.cell) << i;
    EXPECT_EQ(one.position, other.position) << i;
    farthest = std::max(farthest, std::abs(one.cell.first) + std::abs(one.cell.second));
  }
  EXPECT_GT(farthest, 20);
}

INSTANTIATE_TEST_SUITE_P(
    Tables, LongRunsInLanes,
    testing::Values(
        Tabled{"square", "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n"},
        Tabled{"circle", "[table]\nshape = \"circle\"\nradius = 1\n"},
        Tabled{"stadium", "[table]\nshape = \"stadium\"\nhalf_length = 1\nradius = 1\n"},
        Tabled{"sinai", "[table]\nshape = \"sinai\"\nside = 1\nradius = \"1/4\"\ntorus = false\n"},
        Tabled{"mushroom",
               "[table]\nshape = \"mushroom\"\ncap_radius = 1\nstem_width = 1\nstem_height = 1\n"},
        Tabled{"torus", "[table]\nshape = \"sinai\"\nside = 1\nradius = \"1/4\"\ntorus = true\n"},
        Tabled{
            "lorentz",
            "[table]\nshape = \"lorentz\"\nlattice = \"triangular\"\nspacing = 1\nradius = 0.45\n"},
        Tabled{"ellipse", "[table]\nshape = \"ellipse\"\na = 2\nb = 1\n"},
        Tabled{"magnetic_square",
               "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n[field]\nlarmor_radius = "
               "0.5075\n"},
        Tabled{"magnetic_stadium",
               "[table]\nshape = \"stadium\"\nhalf_length = 1\nradius = 1\n[field]\nlarmor_radius "
               "= 2\n"},
        Tabled{"magnetic_mushroom",
               "[table]\nshape = \"mushroom\"\ncap_radius = 1\nstem_width = 1\nstem_height = 1\n"
               "[field]\nlarmor_radius = 2\n"}),
    [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace carom
