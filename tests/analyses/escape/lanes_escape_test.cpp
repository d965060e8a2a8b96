// Escape ensembles in lanes: the digest, the counts and the records of the scalar engine.
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "analyses/escape/records.hpp"
#include "carom/analyses/escape.hpp"
#include "carom/files/system_file.hpp"

namespace carom {
namespace {

System builtin(const std::string& name) {
  for (const BuiltinSystem& b : builtin_systems())
    if (name == b.name) return read_system(std::string(b.toml), name).system;
  throw std::runtime_error("no such system");
}

struct Outcome {
  EscapeResult result;
  std::vector<TrajectoryRecord> records;
};
Outcome run(const System& system, std::optional<InstructionSet> lanes, int threads,
            std::uint64_t block, bool records) {
  Outcome r;
  EscapeOptions how;
  how.lanes = lanes;
  how.threads = threads;
  how.block = block;
  r.result = records ? run_escape(system, how, r.records) : run_escape(system, how);
  return r;
}

void expect_same(const Outcome& a, const Outcome& b) {
  EXPECT_EQ(a.result.digest, b.result.digest);
  EXPECT_EQ(a.result.counts.collisions, b.result.counts.collisions);
  EXPECT_EQ(a.result.counts.escaped, b.result.counts.escaped);
  EXPECT_EQ(a.result.counts.gone_in, b.result.counts.gone_in);
  EXPECT_EQ(a.result.counts.gone_in_hits, b.result.counts.gone_in_hits);
  EXPECT_EQ(a.result.counts.hole_escapes, b.result.counts.hole_escapes);
  EXPECT_EQ(a.result.counts.lost, 0u);
  EXPECT_TRUE(a.result.complete && b.result.complete);
}

class EscapeInLanes : public testing::TestWithParam<const char*> {};

TEST_P(EscapeInLanes, HasTheDigestOfTheScalarEngine) {
  System system = builtin(GetParam());
  system.run.trajectories = 2000;
  const Outcome scalar = run(system, std::nullopt, 1, 512, true);
  EXPECT_FALSE(scalar.result.lanes);
  for (const InstructionSet set : available_instruction_sets())
    for (const int threads : {1, 3})
      for (const bool records : {false, true}) {
        const Outcome lanes = run(system, set, threads, records ? 100 : 700, records);
        ASSERT_TRUE(lanes.result.lanes);
        expect_same(lanes, scalar);
        if (!records) continue;
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

INSTANTIATE_TEST_SUITE_P(BuiltIn, EscapeInLanes,
                         testing::Values("stadium", "mushroom", "circle", "three-disc",
                                         "magnetic-square", "sinai", "lorentz-triangular",
                                         "ellipse-magnetic"));

// Starts far from the home cell are those in the plane, flown in lanes or not.
TEST(LaneRecords, WriteStartsInThePlane) {
  const System system = read_system(R"(
[table]
shape = "lorentz"
lattice = "triangular"
spacing = 2.2
radius = 1
[[table.hole]]
wall = "disc_1"
center = 0.5
width = 0.3
[initial]
kind = "line"
from = [20.1, 3.3]
to = [27, 9]
angle = 0.3
[run]
t_max = 30
trajectories = 50
)",
                                    "far")
                            .system;
  const Outcome scalar = run(system, std::nullopt, 1, 512, true);
  const Outcome lanes = run(system, InstructionSet::baseline, 1, 7, true);
  ASSERT_EQ(lanes.records.size(), scalar.records.size());
  for (std::size_t i = 0; i < lanes.records.size(); ++i) {
    EXPECT_TRUE(lanes.records[i].x > 20 && lanes.records[i].x < 27.01) << lanes.records[i].x;
    EXPECT_EQ(lanes.records[i].x, scalar.records[i].x);
    EXPECT_EQ(lanes.records[i].y, scalar.records[i].y);
  }
}

}  // namespace
}  // namespace carom
