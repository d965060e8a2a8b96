// Rays aimed at joints and tangents, past them by 10^-k: their first hits against plain numbers of
// 1200 bits.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "carom/base/error.hpp"
#include "certify/inside.hpp"
#include "certify/systems.hpp"
#include "certify/wall/ball_table.hpp"
#include "random_tables.hpp"
#include "validation/benchmarks/plain_orbit.hpp"

namespace carom {
namespace {

using certify::Ball;
using certify::BallVector;
using certify::Form;
using certify::Precision;
using certify::WallOf;
using tests::Dice;
using tests::exactly;
using tests::Shaped;
using tests::task_of;

constexpr long decimals = 100;  ///< of starts and fields

BallVector unit(const BallVector& v) {
  const Ball length = sqrt(dot(v, v));
  return {v.x / length, v.y / length};
}

/// A place on a wall, and a direction in which to pass it.
struct Target {
  BallVector place, direction;
};

Target target_on(const WallOf<Ball>& w, Dice& dice) {
  const BallVector any = unit({dice.between(-1, 1), dice.between(-1, 1)});
  if (w.form == Form::segment || (!w.closed && dice.coin()))
    return {dice.coin() ? w.from : w.to, any};
  // Tangent to the whole circle or ellipse: an arc of it may end before.
  const BallVector e = any;
  if (w.form == Form::circle)
    return {w.centre + sqrt(w.radius2) * e, dice.coin() ? left(e) : -left(e)};
  const BallVector a{w.along.x / dot(w.along, w.along), w.along.y / dot(w.along, w.along)};
  const BallVector b{w.across.x / dot(w.across, w.across), w.across.y / dot(w.across, w.across)};
  const BallVector along = unit(e.x * b - e.y * a);
  return {w.centre + e.x * a + e.y * b, dice.coin() ? along : -along};
}

/// Through the target, from a start before it, on a line (radius 0) or on a Larmor circle, either
/// way round; `beside`: how far past the target.
ExactSystem aimed(const Shaped& s, const Target& target, double way, double radius,
                  const Ball& beside, Dice& dice) {
  const BallVector &u = target.direction, T = target.place + beside * left(u);
  BallVector P = T - Ball(way) * u, v = u;
  std::string omega = "0";
  if (radius > 0.0) {
    const Ball r(dice.sign() * radius);  // > 0: clockwise
    const BallVector K = T - r * left(u), from_centre = T - K;
    const double half = way / (2.0 * radius), scale = 1.0 + half * half;
    const Ball c = Ball(1.0 - half * half) / Ball(scale), turn = Ball(2.0 * half) / Ball(scale);
    const Ball norm = sqrt(square(c) + square(turn));
    const Ball back = sign(r) == Sign::positive ? turn : -turn;
    P = K + (c / norm) * from_centre + (back / norm) * left(from_centre);
    v = (Ball(1) / r) * (-left(P - K));
    omega = (Ball(1) / r).decimals(decimals);
  }
  ExactSystem system =
      tests::system_of(s, {exactly(v.x.decimals(decimals)), exactly(v.y.decimals(decimals))});
  system.start.position = {exactly(P.x.decimals(decimals)), exactly(P.y.decimals(decimals))};
  system.omega = exactly(omega);
  return system;
}

Ball written(const std::string& digits) {
  Ball r;
  arb_set_str(r.raw(), digits.c_str(), Precision::bits());
  return r;
}

/// True where some hits were compared.
bool first_hits_agree(const ExactSystem& system, std::uint64_t hits) {
  CertifiedTask task = task_of(hits, 20);
  task.most_bits_a_doubt = 1 << 10;
  CertifiedOrbit orbit(system, task);
  std::vector<CertifiedHit> found;
  for (const CertifiedHit& hit : orbit) found.push_back(hit);
  const CertifiedEnd& end = orbit.end_state();
  if (!end.ties.empty() || end.fate == CertifiedFate::singular)
    return false;  // plain numbers take no notice
  if (end.fate == CertifiedFate::undecided) {
    EXPECT_TRUE(system.table->lattice.has_value()) << end.reason;
  }
  const Precision precision(1200);
  const bench::PlainEnd truth =
      bench::plain_orbit(system, std::max<std::uint64_t>(found.size(), 1), 1200);
  EXPECT_EQ(truth.collisions, found.size()) << name_of(end.fate) << " " << end.reason;
  if (truth.collisions != found.size() || found.empty()) return false;
  const CertifiedHit& last = found.back();
  const certify::Bound rounding(1e-300);
  EXPECT_EQ(truth.wall, last.wall);
  EXPECT_EQ(truth.cell, last.cell);
  EXPECT_TRUE(certify::ball_of(last.t).overlaps(written(truth.t).widened(rounding)));
  EXPECT_TRUE(certify::ball_of(last.x).overlaps(written(truth.x).widened(rounding)));
  EXPECT_TRUE(certify::ball_of(last.y).overlaps(written(truth.y).widened(rounding)));
  EXPECT_TRUE(certify::ball_of(last.vx).overlaps(written(truth.vx).widened(rounding)));
  EXPECT_TRUE(certify::ball_of(last.vy).overlaps(written(truth.vy).widened(rounding)));
  return true;
}

std::string times(const std::string& size, double x) {
  return "(" + size + ")*" + std::to_string(x);
}

Shaped path(const std::string& size, const std::vector<std::pair<double, double>>& corners) {
  Shaped s;
  s.spec.shape = "path";
  LoopSpec loop;
  const auto point = [&](std::size_t i) {
    return ExactPoint{exactly(times(size, corners[i].first)),
                      exactly(times(size, corners[i].second))};
  };
  loop.start = point(0);
  for (std::size_t i = 1; i <= corners.size(); ++i) {
    PieceSpec piece;
    piece.to = point(i % corners.size());
    loop.pieces.push_back(piece);
  }
  s.spec.loops = {loop};
  return s;
}

void bend(Shaped& s, std::size_t piece, const std::string& size, double x, double y,
          const std::string& ratio, const std::string& angle) {
  PieceSpec& p = s.spec.loops[0].pieces[piece];
  p.kind = ratio.empty() ? PieceSpec::Kind::arc : PieceSpec::Kind::ellipse;
  p.via = {exactly(times(size, x)), exactly(times(size, y))};
  if (ratio.empty()) return;
  p.ratio = exactly(ratio);
  p.angle = exactly(angle);
}

// The lower part of an ellipse of 20 by 2, and a deep room beside it; or its mirror image.
Shaped bowl(const std::string& size, bool mirrored) {
  const double s = -0.4358898943540674, m = mirrored ? -1.0 : 1.0;
  std::vector<std::pair<double, double>> corners{{-9, s},  {9, s},  {9, -6},
                                                 {20, -6}, {20, 5}, {-9, 5}};
  for (auto& corner : corners) corner.first *= m;
  if (mirrored) std::reverse(corners.begin(), corners.end());
  Shaped table = path(size, corners);
  bend(table, mirrored ? 4 : 0, size, 0, -1, "1/10", "0");
  // The joints lie on the ellipse as it is written.
  LoopSpec& loop = table.spec.loops[0];
  const std::string exact = "-(" + size + ")*sqrt(19)/10";
  for (PieceSpec& p : loop.pieces)
    if (p.to.y.to_double() < 0.0 && p.to.y.to_double() > exactly(times(size, -1)).to_double())
      p.to.y = exactly(exact);
  if (loop.start.y.to_double() > exactly(times(size, -1)).to_double() &&
      loop.start.y.to_double() < 0.0)
    loop.start.y = exactly(exact);
  return table;
}

/// A box with a flat or deep arc below and a piece of an ellipse above.
Shaped box(const std::string& size, Dice& dice) {
  Shaped s = path(size, {{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  const double flat[] = {-0.1, -1e-5, 1e-5, 0.1, -1e-3};
  const char* ratio[] = {"1/2", "1/30", "20", "3/4", "1/1000"};
  bend(s, 0, size, 0.5, flat[dice.whole(0, 4)], "", "");
  bend(s, 2, size, 0.45, dice.coin() ? 1.2 : 0.9, ratio[dice.whole(0, 4)],
       dice.coin() ? "0" : "0.3");
  return s;
}

/// Discs of radius 1 above the x axis at 10 + 3i, in that order: each meets the axis by 10^-18, or
/// misses it by that; but number 1 reaches well across.
Shaped row_of_discs(const std::vector<int>& order, const std::vector<bool>& met) {
  Shaped s;
  s.spec.shape = "discs";
  s.spec.numbers["radius"] = exactly("1");
  for (const int i : order)
    s.spec.points["centers"].push_back({exactly(std::to_string(10 + 3 * i)),
                                        exactly(i == 1                             ? "1/3"
                                                : met[static_cast<std::size_t>(i)] ? "1-1/10^18"
                                                                                   : "1+1/10^18")});
  s.inside = {exactly("0"), exactly("0")};
  return s;
}

// The Larmor circle passes beside the upper half of the ellipse, which is no wall, and meets the
// bowl later: what may leave through the one must not hide the other.
TEST(Aimed, AnEllipseIsMissedOffItsArc) {
  for (const bool mirrored : {false, true}) {
    for (const char* beside : {"0.2-1/10^20", "0.2+1/10^20", "0.2-1/10^12", "0.2-1/10^6"}) {
      ExactSystem system = tests::system_of(
          bowl("1", mirrored), {exactly(mirrored ? "-0.96" : "0.96"), exactly("0.28")});
      system.start.position = {exactly(mirrored ? "5.6" : "-5.6"), exactly(beside)};
      system.omega = exactly(mirrored ? "-1/20" : "1/20");
      EXPECT_TRUE(first_hits_agree(system, 1)) << beside;
      CertifiedOrbit orbit(system, task_of(1, 20));
      EXPECT_NEAR(orbit.finish().t.to_double(), 13.771336, 1e-5) << beside;
      EXPECT_EQ(orbit.finish().wall, mirrored ? 4 : 0);
    }
  }
}

// However many walls a first look leaves open, the first of them that is met is found.
TEST(Aimed, TheFirstOfManyWallsIsMet) {
  Dice dice(91);
  for (const int count : {16, 17, 18, 19, 40, 100}) {
    for (int k = 0; k < 12; ++k) {
      const bool first_met = k < 8, sure_one_last = dice.coin();
      std::vector<int> order;
      std::vector<bool> met;
      for (int i = 0; i < count; ++i) {
        order.insert(order.begin() + dice.whole(0, i), i);
        met.push_back(i == 0 ? first_met : dice.coin());
      }
      if (sure_one_last) {
        order.erase(std::find(order.begin(), order.end(), 1));
        order.push_back(1);
      }
      CertifiedOrbit orbit(tests::system_of(row_of_discs(order, met), {exactly("1"), exactly("0")}),
                           task_of(1, 20));
      const CertifiedEnd& end = orbit.finish();
      ASSERT_EQ(end.collisions, 1u) << end.reason;
      EXPECT_EQ(order[static_cast<std::size_t>(end.wall)], first_met ? 0 : 1) << count << " discs";
    }
  }
}

TEST(Aimed, FirstHitsAreThoseOfTheAim) {
  Dice dice(92);
  const std::vector<Shaped> shapes = tests::all_shapes();
  const char* sizes[] = {"1", "10^8", "1/10^8"};
  const long rays = tests::cases(1000, 30000);
  long inside = 0, compared = 0;
  for (long k = 0; k < rays; ++k) {
    const std::string size = sizes[dice.whole(0, 2)];
    const double scale = exactly(size).to_double();
    const int kind = dice.whole(0, 5);
    const Shaped s =
        kind < 2 ? box(size, dice)
        : kind == 2
            ? bowl(size, dice.coin())
            : shapes[static_cast<std::size_t>(dice.whole(0, static_cast<int>(shapes.size()) - 1))];
    const Precision precision(500);
    const certify::BallTable table = certify::ball_table(s.spec);
    const auto wall =
        static_cast<std::size_t>(dice.whole(0, static_cast<int>(table.walls.size()) - 1));
    const double reach = kind < 3 ? scale * (kind == 2 ? 8.0 : 1.0) : 1.0;
    const Ball beside =
        Ball(reach * dice.sign()) * written("1e-" + std::to_string(dice.whole(0, 40)));
    ExactSystem system;
    try {
      system = aimed(s, target_on(table.walls[wall], dice), reach * dice.spread(0.01, 1.5),
                     dice.coin() ? reach * dice.spread(0.05, 30.0) : 0.0, beside, dice);
    } catch (const InputError&) {  // the pieces of a box may cross
      continue;
    }
    const ExactPoint& start = system.start.position;
    if (!tests::lies_inside(*system.table, {start.x.to_double(), start.y.to_double()})) continue;
    ++inside;
    SCOPED_TRACE(s.spec.shape + ", ray " + std::to_string(k));
    compared += first_hits_agree(system, 3);
    if (HasFailure()) return;
  }
  RecordProperty("inside", static_cast<int>(inside));
  RecordProperty("compared", static_cast<int>(compared));
  EXPECT_GT(inside, rays / 5);
  EXPECT_GT(compared, inside / 2);
}

}  // namespace
}  // namespace carom
