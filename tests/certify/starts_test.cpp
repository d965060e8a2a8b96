// Starts lie inside the table as it was written, or on the wall they are said to be on, and move.
#include <gtest/gtest.h>

#include "carom/base/error.hpp"
#include "carom/events/world.hpp"
#include "carom/starts/sampler.hpp"
#include "certify/number/exact_value.hpp"
#include "certify/systems.hpp"
#include "certify/wall/containment.hpp"
#include "certify/wall/system_check.hpp"
#include "random_tables.hpp"

namespace carom {
namespace {

using tests::exactly;
using tests::Shaped;
using tests::shaped;
using tests::task_of;

// Why an orbit cannot start; "" if it can.
std::string refusal(const ExactSystem& system) {
  try {
    certify::check_system(system);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}
std::string refusal(Shaped s, const char* x, const char* y) {
  s.inside = {exactly(x), exactly(y)};
  return refusal(tests::system_of(s, {1.0, 0.0}));
}

Shaped square() { return shaped("rectangle", {{"width", "1"}, {"height", "1"}}, "0", "0"); }
Shaped disc_in_square() {
  Shaped s = shaped("sinai", {{"side", "1"}, {"radius", "0.4"}}, "0", "0");
  s.spec.torus = false;
  return s;
}

TEST(CertifiedStarts, StartsOutsideOrOnAWallAreRefused) {
  const auto expect = [](const std::string& message, const std::string& part) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  expect(refusal(square(), "-1", "1/2"), "(-1, 1/2)");
  expect(refusal(square(), "1+1/10^40", "1/2"), "(1+1/10^40, 1/2)");
  expect(refusal(square(), "1", "1/2"), "'right'");
  expect(refusal(square(), "0", "1"), "'top' and 'left'");
  expect(refusal(disc_in_square(), "1/2", "1/2"), "(1/2, 1/2)");
  expect(refusal(disc_in_square(), "1/10", "1/2"), "'disc'");
  expect(refusal(shaped("circle", {{"radius", "1"}}, "0", "0"), "8/17", "15/17"), "'circle'");
  expect(refusal(shaped("circle", {{"radius", "1"}}, "0", "0"), "8/17", "15/17+1/10^20"),
         "15/17+1/10^20");
  expect(refusal(shaped("stadium", {{"half_length", "1"}, {"radius", "1"}}, "0", "0"), "-1-3/5",
                 "4/5"),
         "'left'");
  expect(refusal(shaped("ellipse", {{"a", "2"}, {"b", "1"}}, "0", "0"), "6/5", "4/5"), "'ellipse'");
  // Precision tells a point beside a wall at pi, but not one on it.
  const Shaped odd = shaped("rectangle", {{"width", "pi"}, {"height", "1"}}, "0", "0");
  EXPECT_EQ(refusal(odd, "pi-1/10^1000", "1/2"), "");
  expect(refusal(odd, "pi", "1/2"), "16384 bits");
  // A hair inside.
  for (const char* x : {"1-1/10^40", "1/10^2000", "1/2"})
    EXPECT_EQ(refusal(square(), x, "1/3"), "") << x;
  EXPECT_EQ(refusal(disc_in_square(), "1/10-1/10^40", "1/2"), "");
  // Every orbit asks, in fields, too, and away from the table.
  for (const char* omega : {"0", "1", "-1/10^10"}) {
    for (const char* u : {"1", "-1"}) {
      Shaped s = square();
      s.inside = {exactly("-10"), exactly("1/2")};
      ExactSystem system = tests::system_of(s, {exactly(u), exactly("1/10")});
      system.omega = exactly(omega);
      EXPECT_THROW(CertifiedOrbit(system, task_of(1, 20)), InputError);
    }
  }
}

TEST(CertifiedStarts, StartsWithoutAVelocityAreRefused) {
  ExactSystem system = tests::system_of(shaped("circle", {{"radius", "1"}}, "0", "0"), {0.0, 0.0});
  EXPECT_NE(refusal(system), "");
  system.start.direction.y = exactly("sqrt(8)-2*sqrt(2)");
  EXPECT_NE(refusal(system), "");
  system.start.direction.y = exactly("sqrt(8)-2*sqrt(2)+1/10^900");
  EXPECT_EQ(refusal(system), "");
  system.start.direction.y = exactly("sqrt(2)+sqrt(3)-sqrt(5+2*sqrt(6))");
  EXPECT_NE(refusal(system), "") << "equal to zero, which no precision proves";
}

TEST(CertifiedStarts, StartsOnTheirWallMustPointInwards) {
  for (const Shaped& s : tests::all_shapes()) {
    SCOPED_TRACE(s.spec.shape);
    ExactSystem system = tests::system_of(s, {1.0, 0.0});
    for (std::size_t k = 0; k < system.table->walls.size(); ++k) {
      const geometry::Curve& curve = system.table->walls[k].curve;
      system.start.wall = static_cast<int>(k);
      system.start.u = 0.37 * geometry::end_parameter(curve);
      const geometry::Vector inwards = geometry::normal_at(curve, system.start.u);
      system.start.direction = {inwards.x, inwards.y};
      EXPECT_EQ(refusal(system), "");
      system.start.direction = {-inwards.x, -inwards.y};
      EXPECT_NE(refusal(system), "");
      system.start.u = 1.01 * geometry::end_parameter(curve);
      EXPECT_NE(refusal(system), "");
    }
    system.start.wall = static_cast<int>(system.table->walls.size());
    EXPECT_NE(refusal(system), "");
  }
}

// A block with one round side in each cell of a skew lattice.
Shaped blocks() {
  Shaped s = shaped("path", {}, "0", "0");
  LoopSpec loop;
  loop.start = {exactly("1/5"), exactly("1/5")};
  PieceSpec up, over, down, back;
  up.to = {exactly("1/5"), exactly("4/5")};
  over.kind = PieceSpec::Kind::arc;
  over.via = {exactly("1/2"), exactly("1.1")};
  over.to = {exactly("4/5"), exactly("4/5")};
  down.to = {exactly("4/5"), exactly("1/5")};
  back.to = loop.start;
  loop.pieces = {up, over, down, back};
  s.spec.loops = {loop};
  LatticeSpec lattice;
  lattice.first = {exactly("1"), exactly("0")};
  lattice.second = {exactly("1/4"), exactly("5/4")};
  s.spec.lattice = lattice;
  return s;
}

// In agreement with the engine, which decides by the table's doubles, wherever these are not next
// to a wall.
TEST(CertifiedStarts, StartsAreInsideWhereTheEngineSaysSo) {
  tests::Dice dice(31);
  std::vector<Shaped> shapes = tests::all_shapes();
  shapes.push_back(blocks());
  long inside = 0, all = 0;
  for (const Shaped& s : shapes) {
    SCOPED_TRACE(s.spec.shape);
    const Table table = build_table(s.spec);
    const World world(table);
    const certify::Precision precision(128);
    const certify::BallTable balls = certify::ball_table(s.spec);
    const std::vector<certify::WallLoop> loops = certify::loops_of(table);
    for (long k = 0; k < tests::cases(300, 20000); ++k) {
      geometry::Vector P{dice.between(-2.5, 2.5), dice.between(-2.5, 2.5)};
      if (k % 3 == 0)
        P = {std::round(8.0 * P.x) / 8.0 + 0x1p-20,
             std::round(8.0 * P.y) / 8.0};  // rays into joints
      const certify::Containment place(loops, balls, {P.x, P.y});
      ASSERT_FALSE(place.too_far());
      ++all;
      geometry::Vector in_cell = P;
      geometry::Cell cell;
      fold_into_cell(table, in_cell, cell);
      ASSERT_EQ(place.verdict() == certify::Verdict::yes, world.contains(in_cell))
          << P.x << ", " << P.y;
      inside += place.verdict() == certify::Verdict::yes ? 1 : 0;
    }
  }
  EXPECT_GT(inside, all / 10);
  EXPECT_LT(inside, 9 * all / 10);
}

TEST(CertifiedStarts, StartsMayLieInAnyCell) {
  Shaped torus = shaped("sinai", {{"side", "1"}, {"radius", "0.4"}}, "0", "0");
  EXPECT_EQ(refusal(torus, "10^6+0.05", "-10^6+0.07"), "");
  EXPECT_NE(refusal(torus, "10^6+0.5", "-10^6+0.7"), "");
  EXPECT_NE(refusal(torus, "10^6+0.1", "0.5"), "");
  EXPECT_EQ(refusal(torus, "10^6+0.1-1/10^60", "0.5"), "");
}

// Where the doubles of a table have other walls than its numbers, it is refused.
TEST(CertifiedStarts, TablesWithOtherWallsInDoublesAreRefused) {
  const auto mushroom = [](const char* stem) {
    return shaped("mushroom", {{"cap_radius", "1"}, {"stem_width", stem}, {"stem_height", "1"}},
                  "1/5", "1/5");
  };
  EXPECT_EQ(refusal(mushroom("2"), "1/5", "1/5"), "");
  EXPECT_EQ(refusal(mushroom("2-1/10^10"), "1/5", "1/5"), "");
  EXPECT_NE(refusal(mushroom("2-2/10^20"), "1/5", "1/5"), "");
  EXPECT_NE(refusal(mushroom("2+2/10^20"), "1/5", "1/5"), "");
  EXPECT_EQ(refusal(mushroom("sqrt(3)-sqrt(12)+sqrt(3)+2"), "1/5", "1/5"), "");
}

}  // namespace
}  // namespace carom
