// Straight flights among the discs of a convex table, or of the cell of a lattice, that holds
// nothing else.
#include <cmath>

#include "base/index.hpp"
#include "events/flight/crossing.hpp"
#include "events/flight/next_hit.hpp"

namespace carom::events {

using namespace geometry;

namespace {

using base::at;

}  // namespace

/// A line leaves a convex region once: between a joint on its right and the next one on its left,
/// or, with all joints on one side, through the arc that it is on. -1: not decided.
[[gnu::always_inline]] inline int HitFinder::exit_of_enclosure(const Flight& f, Vector origin,
                                                               const FlightScale& scale) const {
  const int n = t_.enclosure_size;
  if (n == 1) return t_.enclosure_first;
  const Vector v = f.velocity;
  const Vector* joints = t_.joints.data() + t_.enclosure_first;
  const double bound = 0.5 * side_error(scale, t_.reach + norm_1(origin));
  bool decided = true, before = geometry::cross(v, joints[n - 1] - origin) > 0.0;
  int exit = -1, piece = n - 1;
  for (int i = 0; i < n; ++i) {
    const double side = geometry::cross(v, joints[i] - origin);
    decided &= std::fabs(side) > bound;
    const bool left = side > 0.0;
    if (!before & left) exit = piece;
    before = left;
    piece = i;
  }
  if (!decided) {  // once more with a bound for each joint
    for (int i = 0; i < n; ++i) {
      const Vector d = joints[i] - origin;
      if (!(std::fabs(geometry::cross(v, d)) > 0.5 * side_error(scale, norm_1(d)))) return -1;
    }
  }
  if (exit >= 0) return t_.enclosure_first + exit;
  const int start = f.start_piece - t_.enclosure_first;
  return start >= 0 && start < n && t_.data[at(f.start_piece)].kind != CurveKind::segment
             ? f.start_piece
             : -1;
}

/// A disc that the line meets comes before the enclosure.
bool HitFinder::filtered_enclosed(const Flight& f, Ahead& ahead) const {
  if (f.start_previous >= 0) return false;  // from a joint: by algebra
  const Vector v = f.velocity;
  const Vector origin = t_.cells ? origins_[0].point : f.start;
  const FlightScale scale = {t_.cells ? origins_[0].scale.delta : f.start_error, norm_1(v), 0.0,
                             t_.options.filter_inflation};
  int best = -1;
  Quotient first{0.0, 1.0};
  for (const int disc : t_.discs) {
    if (disc == f.start_piece) continue;  // a line leaves a disc for good
    const PreparedCurve& w = *t_.data[at(disc)].shape;
    const Vector e = origin - w.centre;
    const Quadratic<double> q = circle_quadratic(e, w.r2, v, f.square_speed);
    const double discriminant = discriminant_of(q);
    const QuadraticError error = circle_error(scale, norm_1(e), w.centre_error, w.r2);
    const double margin = discriminant_error(q, error);
    // Outside the disc, as the particle is, the line's crossings are ahead exactly when b < 0.
    if ((q.b < 0.0) & (discriminant > 0.0)) {
      if (!((q.b < -error.b) & (discriminant > margin))) return false;
      if (best >= 0) return false;  // two: by comparing them
      best = disc;
      first = {q.a, std::sqrt(discriminant) - q.b};
    } else if (!((q.b > error.b) | (discriminant < -margin))) {
      return false;
    }
  }
  if (best < 0) {
    best = exit_of_enclosure(f, origin, scale);
    if (best < 0) return false;
    const PreparedCurve& w = *t_.data[at(best)].shape;
    if (w.kind == CurveKind::segment) {
      first = {geometry::fused_cross(w.tangent, origin - w.from),
               -geometry::fused_cross(w.tangent, v)};
    } else {
      const bool on_wall = best == f.start_piece;
      const Quadratic<double> q = quadratic<false>(w, origin, v, f.square_speed, 0.0, on_wall);
      first = straight_time(q, on_wall ? std::fabs(q.b) : std::sqrt(discriminant_of(q)));
    }
  }
  const double duration = first.time / first.unit;
  if (!(duration > 0.0 && duration < HUGE_VAL)) return false;  // too short a way for doubles
  ahead.kind = t_.data[at(best)].edge ? Ahead::Kind::edge : Ahead::Kind::wall;
  ahead.piece = best;
  ahead.root = 0;
  ahead.kappa = first.unit / first.time;
  ahead.duration = duration;
  return true;
}

}  // namespace carom::events
