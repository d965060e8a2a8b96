#include "certify/enclosure/line_table.hpp"

#include "certify/wall/rational_table.hpp"

namespace carom::certify {
namespace {

bool is_zero(const Ball& x) { return arb_is_zero(x.raw()) != 0; }

// A vector along the segment, of any length: (1, 0) and (0, 1) have short products.
BallVector direction_of(const WallOf<Ball>& segment) {
  if (is_zero(segment.chord.y)) return {Ball(1), Ball(0)};
  if (is_zero(segment.chord.x)) return {Ball(0), Ball(1)};
  return segment.chord;
}

LineWall line_wall(const WallOf<Ball>& w, const MotionOf<Ball>& motion) {
  LineWall r;
  r.arc = w.form == Form::circle;
  if (r.arc) {
    r.side = w.turn > 0 ? 1.0 : -1.0;
    r.anchor = w.centre;
    r.size2 = w.radius2 * motion.speed2;
    r.inverse.value = Ball(1) / r.size2;
    r.radius = std::sqrt(w.radius2.to_double());
    return r;
  }
  r.anchor = w.from;
  r.tangent = direction_of(w);
  const Ball scale = Ball(2) / dot(r.tangent, r.tangent);
  r.double_tangent = scale * r.tangent;
  return r;
}

LineWall rounded(const LineWall& w) {
  return {w.arc,
          w.side,
          rounded(w.anchor),
          rounded(w.tangent),
          rounded(w.double_tangent),
          w.size2.rounded(),
          {w.inverse.value.rounded(), w.inverse.above, w.inverse.below},
          w.radius};
}

}  // namespace

Ball Factor::times(Ball x) const {
  if (below == 0) return value * x;
  if (above != 1) arb_mul_si(x.raw(), x.raw(), above, Precision::bits());
  if (below != 1) arb_div_ui(x.raw(), x.raw(), below, Precision::bits());
  return x;
}

LineTable::LineTable(const SceneOf<Ball>& scene, long few) : few_bits(few) {
  for (const WallOf<Ball>& w : scene.walls) walls.push_back(line_wall(w, scene.motion));
  const Precision precision(few);
  for (const LineWall& w : walls) few_walls.push_back(rounded(w));
  few_inverse_speed2 = scene.motion.inverse_speed2.rounded();
}

void LineTable::shorten(const ExactSystem& system) {
  try {
    const TableOf<Rational> table = rational_table(*system.spec);
    const Rational speed2 = square(Rational(system.speed));
    for (std::size_t i = 0; i < walls.size(); ++i) {
      if (!walls[i].arc) continue;
      const Rational size2 = table.walls[i].radius2 * speed2;
      const mpq_class* const q = size2.value();
      if (q == nullptr || !q->get_num().fits_slong_p() || !q->get_den().fits_slong_p()) continue;
      walls[i].inverse.above = q->get_den().get_si();
      walls[i].inverse.below = q->get_num().get_ui();
    }
  } catch (const NotRational&) {
    // The table needs the sign of another number, and the constants stay long.
  }
}

bool LineTable::holds(const SceneOf<Ball>& scene) {
  if (scene.motion.turns) return false;
  for (const WallOf<Ball>& w : scene.walls)
    if (w.form == Form::ellipse) return false;
  return true;
}

void LineTable::round() {
  for (LineWall& w : walls) w = rounded(w);
}

}  // namespace carom::certify
