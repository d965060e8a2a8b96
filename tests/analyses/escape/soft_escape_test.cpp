// Escape ensembles under forces: in lanes of any kind, threads and blocks, what the scalar engine
// gives.
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "analyses/escape/records.hpp"
#include "carom/analyses/escape.hpp"
#include "carom/files/system_file.hpp"

namespace carom {
namespace {

System well_with_a_hole() {
  return read_system(R"(
[table]
shape = "stadium"
half_length = 0.5
radius = 1
[[table.hole]]
wall = "bottom"
center = 0.5
width = 0.1
[[table.hole]]
wall = "left"
center = 1
width = 0.1
[[potential]]
kind = "harmonic"
omega = 0.6
[field]
B = 0.5
[integrator]
step = 0.1
[particles]
speed = 1.5
[initial]
kind = "boundary"
[run]
t_max = 40
trajectories = 300
)",
                     "well")
      .system;
}

struct Outcome {
  EscapeResult result;
  std::vector<TrajectoryRecord> records;
};
Outcome run(const System& system, std::optional<InstructionSet> lanes, int threads,
            std::uint64_t block) {
  Outcome r;
  EscapeOptions how;
  how.lanes = lanes;
  how.threads = threads;
  how.block = block;
  r.result = run_escape(system, how, r.records);
  return r;
}

TEST(SoftEscape, IsTheSameInEveryWay) {
  const System system = well_with_a_hole();
  const Outcome scalar = run(system, std::nullopt, 1, 512);
  EXPECT_FALSE(scalar.result.lanes);
  EXPECT_GT(scalar.result.counts.escaped, 30u);
  EXPECT_LT(scalar.result.counts.escaped, 290u);
  for (const InstructionSet set : available_instruction_sets())
    for (const std::uint64_t block : {7u, 1000u}) {
      const Outcome lanes = run(system, set, block == 7 ? 2 : 1, block);
      ASSERT_TRUE(lanes.result.lanes);
      EXPECT_EQ(lanes.result.digest, scalar.result.digest);
      EXPECT_EQ(lanes.result.counts.collisions, scalar.result.counts.collisions);
      EXPECT_EQ(lanes.result.counts.gone_in, scalar.result.counts.gone_in);
      EXPECT_EQ(lanes.result.counts.hole_escapes, scalar.result.counts.hole_escapes);
      EXPECT_EQ(lanes.result.counts.lost, 0u);
      EXPECT_GT(lanes.result.effort.hits, 2 * lanes.result.effort.scalar);
      ASSERT_EQ(lanes.records.size(), scalar.records.size());
      for (std::size_t i = 0; i < lanes.records.size(); ++i) {
        const TrajectoryRecord &a = lanes.records[i], &b = scalar.records[i];
        ASSERT_TRUE(a.index == b.index && a.x == b.x && a.y == b.y && a.vx == b.vx &&
                    a.vy == b.vy && a.fate == b.fate && a.hole == b.hole && a.time == b.time &&
                    a.hits == b.hits)
            << i;
      }
    }
}

}  // namespace
}  // namespace carom
