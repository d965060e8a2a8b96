// Long runs in lanes: every particle makes all its hits, or ends where a limit does not exist.
#include <gtest/gtest.h>

#include <carom/carom.hpp>
#include <string>

#include "carom/lanes/lane_world.hpp"
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
  const auto trajectories = static_cast<std::uint64_t>(tests::cases(100, 100'000));  // 10^6 hits, or 10^9
  const std::string text = std::string(GetParam().text) +
                           "[particles]\nspeed = 1\n[initial]\nkind = \"boundary\"\n"
                           "[run]\nt_max = 1e9\ncollisions = 10000\ntrajectories = 1\n";
  const System system = read_system(text, GetParam().name).system;
  World world(*system.table);
  const Sampler sampler(system);
  ASSERT_TRUE(LaneWorld::suits(*system.table, system.particles));
  LaneWorld lanes(*system.table, system.particles, widest_instruction_set());
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
        if (end.fate == Fate::capped) { EXPECT_EQ(end.hits, hits_each); }
      });
  EXPECT_EQ(capped + singular + pinned, trajectories);
  EXPECT_GT(capped, trajectories / 2);
  const LaneEffort& effort = lanes.effort();
  EXPECT_LT(static_cast<double>(effort.scalar), 1e-3 * static_cast<double>(effort.hits));
  RecordProperty("hits", std::to_string(effort.hits));
  std::printf("%s: %llu hits, %llu by the scalar engine, %llu singular, lost none\n", GetParam().name,
              static_cast<unsigned long long>(effort.hits), static_cast<unsigned long long>(effort.scalar),
              static_cast<unsigned long long>(singular));
}

INSTANTIATE_TEST_SUITE_P(
    Tables, LongRunsInLanes,
    testing::Values(
        Tabled{"square", "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n"},
        Tabled{"circle", "[table]\nshape = \"circle\"\nradius = 1\n"},
        Tabled{"stadium", "[table]\nshape = \"stadium\"\nhalf_length = 1\nradius = 1\n"},
        Tabled{"sinai", "[table]\nshape = \"sinai\"\nside = 1\nradius = \"1/4\"\ntorus = false\n"},
        Tabled{"mushroom", "[table]\nshape = \"mushroom\"\ncap_radius = 1\nstem_width = 1\nstem_height = 1\n"},
        Tabled{"torus", "[table]\nshape = \"sinai\"\nside = 1\nradius = \"1/4\"\ntorus = true\n"},
        Tabled{"lorentz", "[table]\nshape = \"lorentz\"\nlattice = \"triangular\"\nspacing = 1\nradius = 0.45\n"},
        Tabled{"ellipse", "[table]\nshape = \"ellipse\"\na = 2\nb = 1\n"},
        Tabled{"magnetic_square", "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n[field]\nlarmor_radius = 0.5075\n"},
        Tabled{"magnetic_stadium",
               "[table]\nshape = \"stadium\"\nhalf_length = 1\nradius = 1\n[field]\nlarmor_radius = 2\n"},
        Tabled{"magnetic_mushroom", "[table]\nshape = \"mushroom\"\ncap_radius = 1\nstem_width = 1\nstem_height = 1\n"
                                    "[field]\nlarmor_radius = 2\n"}),
    [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace carom
