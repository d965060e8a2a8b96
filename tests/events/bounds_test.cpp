// The event loop's own bounds against the errors they bound: never above them, and not idle.
#include "events/flight/bounded.hpp"

#include "geometry/bounds.hpp"

namespace carom::tests {

using namespace events;

namespace {

using namespace bounds;
using namespace geometry;

Curve random_arc(double size, Dice& dice) {
  const double offset = dice.sign() * (dice.coin() ? dice.between(0, 2) : dice.spread(1, 1e6));
  return CircularArc{place(size, dice), place(size, dice), offset, dice.coin()};
}

Curve random_elliptic_arc(double size, Dice& dice) {
  const double offset = dice.sign() * (dice.coin() ? dice.between(0, 2) : dice.spread(1, 1e4));
  return EllipticArc{
      place(size, dice), place(size, dice), dice.direction(), dice.spread(0.05, 1.0), offset,
      dice.coin()};
}

/// A crossing: kappa of the exact start, and the rounded one with its error (infinite: cannot
/// tell).
struct Crossing {
  Quad exact = 0;
  double kappa = 0.0, error = HUGE_VAL;
};

Crossing rising(const Quadratic<Quad>& exact, const Quadratic<double>& q, const QuadraticError& e) {
  const Root found = rising_root(q);
  Crossing c{0, found.kappa, kappa_error(q, e, found)};
  if (!(c.error < HUGE_VAL)) return c;
  const Quad n = root(exact.b * exact.b - exact.a * exact.c);
  c.exact = q.b <= 0.0 ? (n - exact.b) / exact.a : -exact.c / (exact.b + n);
  return c;
}

/// An ellipse: without field.
Crossing crossing(const Sample& s, const Scene& scene) {
  const PreparedCurve& w = scene.rounded;
  const QuadCurve& q = scene.exact;
  const QuadVector v = quad(s.velocity);
  Quadratic<Quad> exact;
  if (w.kind == CurveKind::segment) {
    const QuadVector d = q.to - q.from;
    exact = line_quadratic(s.exact_start - q.from, (Quad(1) / root(dot(d, d))) * d, v,
                           Quad(s.omega), Quad(0.5));
  } else if (w.kind == CurveKind::ellipse) {
    const QuadVector e = s.exact_start - q.centre;
    const Quad r2 = q.metric(q.a, q.a);
    exact = {q.metric(e, e) / r2 - Quad(1), q.metric(e, v) / r2, q.metric(v, v) / r2};
  } else {
    exact = circle_quadratic(s.exact_start - q.centre, dot(q.a, q.a), v, dot(v, v), Quad(s.omega),
                             Quad(0.5));
  }
  if (w.orientation > 0 && w.kind != CurveKind::segment) exact = -exact;
  const auto rounded = s.omega == 0.0
                           ? quadratic<false>(w, s.start, s.velocity, s.square, 0.0, false)
                           : quadratic<true>(w, s.start, s.velocity, s.square, s.omega, false);
  return rising(exact, rounded, quadratic_error(w, s.start, s.scale, false));
}

TEST(EventBounds, SideOfTheChordHasItsBound) {
  const auto arc = [](double size, Dice& dice) {
    return dice.coin() ? random_arc(size, dice) : random_elliptic_arc(size, dice);
  };
  sweep("side of the chord (on_part)", arc, [](Sample s, const Scene& scene, Dice&, Ratios& r) {
    const bool elliptic = scene.rounded.kind == CurveKind::ellipse;
    if (elliptic) s.omega = s.scale.omega = 0.0;
    const Crossing c = crossing(s, scene);
    if (!(c.error < HUGE_VAL)) return;
    const QuadCurve& q = scene.exact;
    const QuadVector x =
        s.exact_start + displacement(c.exact, quad(s.velocity), Quad(s.omega), Quad(0.5));
    const ChordSide side =
        side_of_chord(scene.rounded, s.start, s.velocity, s.omega, c.kappa, c.error, s.scale);
    r.add(elliptic ? "side of the chord, ellipse" : "side of the chord, circle",
          Quad(-scene.rounded.orientation) * cross(q.to - q.from, x - q.from), side.value,
          side.bound);
  });
}

TEST(EventBounds, StartBeyondTheChordHasItsBound) {
  sweep("side of the chord at the start (kappa_beyond_chord)", random_elliptic_arc,
        [](const Sample& s, const Scene& scene, Dice&, Ratios& r) {
          const QuadCurve& q = scene.exact;
          const ChordSide side = start_beyond_chord(scene.rounded, s.start, s.scale);
          r.add("start beyond the chord",
                Quad(scene.rounded.orientation) * cross(q.to - q.from, s.exact_start - q.from),
                side.value, side.bound);
        });
}

TEST(EventBounds, FootBeyondTheChordHasItsBound) {
  sweep("foot of an arc's centre (foot_off_arc)", random_arc,
        [](const Sample& s, const Scene& scene, Dice&, Ratios& r) {
          const QuadCurve& q = scene.exact;
          const QuadVector v = quad(s.velocity), chord = q.to - q.from;
          const QuadVector foot =
              s.exact_start - (dot(s.exact_start - q.centre, v) / dot(v, v)) * v;
          const ChordSide side = foot_beyond_chord(scene.rounded, s.start, s.velocity, s.scale);
          r.add("foot beyond the chord",
                Quad(scene.rounded.orientation) * dot(v, v) * cross(chord, foot - q.from),
                side.value, side.bound);
        });
}

TEST(EventBounds, FeetOfALarmorCircleHaveTheirBounds) {
  sweep("foot of a Larmor circle's centre (foot_between)", random_segment,
        [](const Sample& s, const Scene& scene, Dice&, Ratios& r) {
          if (s.omega == 0.0) return;
          const QuadCurve& q = scene.exact;
          const QuadVector v = quad(s.velocity), d = q.to - q.from,
                           t = (Quad(1) / root(dot(d, d))) * d;
          const Quad omega(s.omega), turn(s.omega > 0.0 ? 1.0 : -1.0);
          const QuadVector centre = s.exact_start + (Quad(1) / omega) * right(v);
          const Feet feet = feet_of_centre(scene.rounded, s.start, s.velocity, s.omega, s.scale);
          r.add("foot beyond the start", turn * omega * dot(centre - q.from, t), feet.first,
                feet.bound);
          r.add("foot before the end", turn * omega * dot(q.to - centre, t), feet.last, feet.bound);
        });
}

TEST(EventBounds, TimeOfAStraightFlightToASegmentHasItsBound) {
  sweep("straight_line_error", random_segment, [](Sample s, const Scene& scene, Dice&, Ratios& r) {
    s.omega = s.scale.omega = 0.0;
    const PreparedCurve& w = scene.rounded;
    const QuadCurve& q = scene.exact;
    const double time = cross(w.tangent, s.start - w.from),
                 kappa = -cross(w.tangent, s.velocity) / time;
    const double bound = straight_line_error(w, s.start, s.scale, kappa, time);
    if (!(bound < HUGE_VAL)) return;
    const QuadVector d = q.to - q.from;
    r.add("kappa of a segment", -cross(d, quad(s.velocity)) / cross(d, s.exact_start - q.from),
          kappa, bound);
  });
}

/// The parameter of a point on a curve.
Quad parameter(const QuadCurve& q, const QuadVector& x) {
  const QuadVector e = x - q.from;
  if (q.segment) return dot(e, q.to - q.from) / dot(q.to - q.from, q.to - q.from);
  const QuadVector f = x - q.centre;
  const Quad area = cross(q.a, q.b);
  Quad c = cross(f, q.b) / area, s = cross(q.a, f) / area;
  int quarter = 0;
  while (!(c > 0 && s >= 0)) {  // a quarter back
    const Quad before = c;
    c = s;
    s = -before;
    ++quarter;
  }
  return Quad(quarter) + s / (Quad(1) + c);
}

TEST(EventBounds, ParameterOfALandingHasItsBound) {
  const auto any = [](double size, Dice& dice) {
    const int kind = dice.whole(0, 3);
    return kind == 0   ? random_segment(size, dice)
           : kind == 1 ? random_arc(size, dice)
           : kind == 2 ? random_circle(size, dice)
                       : random_ellipse(size, dice);
  };
  sweep("parameter of a landing (hole_at)", any,
        [](Sample s, const Scene& scene, Dice&, Ratios& r) {
          const PreparedCurve& w = scene.rounded;
          if (w.kind == CurveKind::ellipse) s.omega = s.scale.omega = 0.0;
          const Crossing c = crossing(s, scene);
          if (!(c.error < HUGE_VAL) || (s.omega == 0.0 && !(c.kappa > 0.0))) return;
          const QuadVector exact =
              s.exact_start + displacement(c.exact, quad(s.velocity), Quad(s.omega), Quad(0.5));
          const Quad u = parameter(scene.exact, exact);
          // Crossings of the piece itself; those near its ends are clamped, and no flight lands
          // beyond.
          if (!(double(u) > 1e-3 && double(u) < w.last() - 1e-3)) return;
          const Vector way = s.omega == 0.0 ? (1.0 / c.kappa) * s.velocity
                                            : displacement(c.kappa, s.velocity, s.omega, 0.5);
          PreparedCurve::Arrival at;
          w.arrive(s.start + way, s.velocity, at);
          const double bound = parameter_error(
              w, s.start, bounds::norm_1(displacement(c.kappa, s.velocity, s.omega, 0.5)), c.kappa,
              c.error, s.scale);
          if (!(bound < 0.1)) return;
          r.add(w.kind == CurveKind::segment   ? "parameter on a segment"
                : w.kind == CurveKind::ellipse ? "parameter on an ellipse"
                                               : "parameter on a circle",
                u, at.u, bound);
        });
}

}  // namespace
}  // namespace carom::tests
