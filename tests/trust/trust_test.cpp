// How far double precision can be trusted, against orbits in 113 bits.
#include "carom/trust/trust.hpp"
#include "carom/events/world.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "random_tables.hpp"
#include "trust/quad_orbit.hpp"

namespace carom::tests {
namespace {

struct Case {
  const char* name;
  Table table;
  double omega = 0.0;
  double tolerance = TrustRecorder::usual_tolerance;
  std::uint64_t most_hits = 1000;
  bool chaotic = true;  ///< most orbits part within these hits
  Table unfolded{};     ///< of a lattice: many copies of its disc in the open plane
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

// With unit speed.
QuadVector direction(Vector v) {
  const QuadVector q = quad(v);
  return (1 / root(dot(q, q))) * q;
}

// Both orbits hit by hit.
class Comparison : public Observer {
 public:
  Comparison(const Case& c, const State& start)
      : trust(c.table, c.tolerance),
        table_(c.table),
        truth_(c.table.lattice ? c.unfolded : c.table, quad(start.position),
               direction(start.velocity), c.omega),
        size_(size_of(c.table)),
        tolerance_(c.tolerance) {}

  void hit(const HitEvent& event) override {
    trust.hit(event);
    if (parted) return;
    const QuadHit& there = truth_.next();
    Vector position = event.position;
    if (table_.lattice) position = position + table_.lattice->translation(event.cell);
    const QuadVector away = quad(position) - there.position,
                     turn = quad(event.after) - there.velocity;
    const Quad late = magnitude(Quad(event.time.high) + Quad(event.time.low) - there.time);
    const double error = std::max({largest(away) / size_, double(late) / size_, largest(turn)});
    if ((table_.lattice || there.wall == event.wall) && error <= tolerance_)
      ++together;
    else
      parted = true;
  }

  TrustRecorder trust;
  std::uint64_t together = 0;  ///< hits before the first that is wrong
  bool parted = false;

 private:
  const Table& table_;
  QuadOrbit truth_;
  double size_, tolerance_;
};

class Trusted : public testing::TestWithParam<Case> {};

TEST_P(Trusted, EndsBeforeTheTruthPartsAndNotLongBefore) {
  const Case& c = GetParam();
  World world(c.table);
  world.limit_hits(c.most_hits);
  Dice dice(7);
  const geometry::Box box{{-2, -2}, {2, 2}};
  std::vector<double> ratios;
  long starts = 0;
  const long wanted = cases(250, 2500);
  while (starts < wanted) {
    State state;
    state.position = {dice.between(box.low.x, box.high.x), dice.between(box.low.y, box.high.y)};
    state.velocity = dice.direction();
    if (!world.contains(state.position)) continue;
    ++starts;
    Particle particle;
    particle.omega = c.omega;
    world.clear();
    world.add(particle, state);
    Comparison both(c, state);
    both.trust.follow(particle, state, 0);
    world.run_until(1e6, both);
    const Trust& trust = both.trust.trust(0);
    if (!both.parted) continue;
    ratios.push_back(double(trust.hits) / double(both.together));
    EXPECT_LE(trust.hits, both.together) << c.name << " start " << starts;
  }
  std::sort(ratios.begin(), ratios.end());
  if (c.chaotic) {
    ASSERT_GT(ratios.size(), static_cast<std::size_t>(wanted / 2));
  }
  if (ratios.empty()) return;
  const double median = ratios[ratios.size() / 2];
  RecordProperty("parted", static_cast<int>(ratios.size()));
  RecordProperty("least", std::to_string(ratios.front()));
  RecordProperty("median", std::to_string(median));
  RecordProperty("largest", std::to_string(ratios.back()));
  EXPECT_GE(median, 0.7);
}

// Unit discs on a triangular lattice, and those of them that a short orbit may meet.
constexpr Vector first{2.2, 0.0}, second{1.1, 1.9052558883257650};
Table copies(int reach) {
  std::vector<Vector> centres;
  const Table table = lorentz(first, second);  // its vectors are rounded to a grid
  for (int i = -reach; i <= reach; ++i)
    for (int j = -reach; j <= reach; ++j) centres.push_back(table.lattice->translation({i, j}));
  return discs(centres);
}

const Case systems[] = {
    {"circle", disc(1.0), 0.0, 1e-12, 3000, false},
    {"circle_field", disc(1.0), 0.7, 1e-12, 3000, false},
    {"stadium", stadium()},
    {"sinai", sinai()},
    {"square", square(), 0.0, 1e-12, 3000, false},
    {"magnetic_square", square(), 1.0 / 0.5075},
    {"magnetic_stadium", stadium(), -0.8},
    {"magnetic_sinai", sinai(), 1.3},
    {"mushroom", mushroom(1.0, 0.5, 1.0)},
    {"lorentz", lorentz(first, second), 0.0, TrustRecorder::usual_tolerance, 200, true, copies(10)},
};
// A hole that hardly any orbit meets: beside it a neighbour is flown to each hit.
Trust trust_of(Table table, const State& start, bool with_hole) {
  if (with_hole) {
    table.holes.push_back({"hole", 0, 0.5, 0.5 + 0x1p-45});
    table.walls[0].holes.push_back(0);
  }
  World world(table);
  world.limit_hits(1000);
  world.add(Particle{}, start);
  TrustRecorder trust(table);
  trust.follow(Particle{}, start, 0);
  world.run_until(1e6, trust);
  return trust.trust(0);
}

TEST(Trust, NeedsNoNeighbourWhereNoJointIsNear) {
  Dice dice(11);
  for (const Table& table : {square(), stadium(), disc(1.0)})
    for (long i = 0; i < cases(150, 1500); ++i) {
      State start;
      start.position = {dice.between(0.0, 0.7), dice.between(0.0, 0.7)};
      start.velocity = dice.direction();
      const Trust alone = trust_of(table, start, false), beside = trust_of(table, start, true);
      ASSERT_EQ(alone.hits, beside.hits) << i;
      EXPECT_EQ(alone.open, beside.open);
      EXPECT_EQ(alone.error.position, beside.error.position);
      EXPECT_EQ(alone.error.time, beside.error.time);
    }
}

INSTANTIATE_TEST_SUITE_P(Systems, Trusted, testing::ValuesIn(systems),
                         [](const auto& which) { return std::string(which.param.name); });

}  // namespace
}  // namespace carom::tests
