// Convex enclosures: a convex table, or the cell of a lattice, that holds nothing but discs. Here:
// which they are, and straight flights among discs.
#include <algorithm>
#include <cmath>

#include "carom/geometry/hull.hpp"
#include "events/flight/crossing.hpp"
#include "events/flight/next_hit.hpp"

namespace carom {

using namespace geometry;

namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

/// A table is enclosed if one loop of convex pieces, in their order, holds everything else, which
/// is discs.
void HitFinder::find_enclosure(bool complement) {
  if (complement || offsets_.size() > 1) return;  // a displaced wall reaches into the cell
  if (table_.crossing) return;                    // then a disc may reach beyond the loop
  std::vector<int> loop, discs;
  for (int i = 0; i < static_cast<int>(data_.size()); ++i) {
    const PreparedCurve& w = curves_[at(data_[at(i)].curve)];
    const bool inside = w.kind == CurveKind::segment || w.orientation > 0;
    if (inside)
      loop.push_back(i);
    else if (w.closed && w.kind == CurveKind::circle)
      discs.push_back(i);
    else
      return;
  }
  if (loop.empty()) return;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const PieceData& p = data_[at(loop[k])];
    if (loop[k] != loop[0] + static_cast<int>(k)) return;
    if (p.closed && loop.size() == 1) break;
    if (p.closed || p.next != loop[(k + 1) % loop.size()] ||
        exact_->corner(loop[k], p.next).turn < 0)
      return;
  }
  enclosure_first_ = loop.front();
  enclosure_size_ = static_cast<int>(loop.size());
  discs_ = std::move(discs);
  discs_within_ = cells_;
  for (const int disc : discs_)
    for (const int edge : loop) {
      const PreparedCurve& w = *data_[at(disc)].shape;
      const PreparedCurve& e = *data_[at(edge)].shape;
      // As for the images of walls: with the rounding of this comparison on the safe side.
      const double gap = geometry::cross(e.tangent, w.centre - e.from) - std::sqrt(w.r2);
      discs_within_ &= gap > 32.0 * unit_roundoff * (2.0 * w.extent + 2.0 * norm_1(e.from));
    }
  if (!discs_.empty() || cells_ || enclosure_size_ > Enclosure::most) return;
  // The walls alone, and in their order.
  Box box = bounding_box(table_.walls.front().curve);
  without_ellipses_ = true;
  for (int i = 0; i < enclosure_size_; ++i) {
    const PreparedCurve& w = curves_[at(i)];
    const bool bent = w.kind != CurveKind::segment;
    enclosure_.add(w.from, bent ? Vector{} : w.tangent, w.length, bent);
    without_ellipses_ &= w.kind != CurveKind::ellipse;
    box = hull(box, bounding_box(table_.walls[at(i)].curve));
  }
  enclosure_.set_diameter(1.01 * norm_1(box.high - box.low));
  enclosure_rounding_ = 4.1 * unit_roundoff * enclosure_.diameter();
}

bool HitFinder::surely_inside(Vector point) const {
  if (enclosure_.size() < 3) return false;
  for (int i = 0; i < enclosure_size_; ++i) {
    const PreparedCurve& w = curves_[at(i)];
    const Vector chord = w.to - w.from, e = point - w.from;
    // Each coordinate of e and chord errs by enclosure_rounding_ and its own last digit; products
    // and difference 2u.
    const double bound = (norm_1(chord) + norm_1(e)) * enclosure_rounding_ +
                         4.1 * unit_roundoff * norm_1(chord) * norm_1(e);
    if (!(geometry::cross(chord, e) > options_.filter_inflation * bound)) return false;
  }
  return true;
}

/// A line leaves a convex region once: between a joint on its right and the next one on its left,
/// or, with all joints on one side, through the arc that it stands on. -1: not decided.
[[gnu::always_inline]] inline int HitFinder::exit_of_enclosure(const Flight& f, Vector origin,
                                                               const FlightScale& scale) const {
  const int n = enclosure_size_;
  if (n == 1) return enclosure_first_;
  const Vector v = f.velocity;
  const Vector* joints = joints_.data() + enclosure_first_;
  const double bound = 0.5 * side_error(scale, reach_ + norm_1(origin));
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
  if (exit >= 0) return enclosure_first_ + exit;
  const int start = f.start_piece - enclosure_first_;
  return start >= 0 && start < n && data_[at(f.start_piece)].kind != CurveKind::segment
             ? f.start_piece
             : -1;
}

/// A disc that the line meets comes before the enclosure.
bool HitFinder::filtered_enclosed(const Flight& f, Ahead& ahead) const {
  if (f.start_previous >= 0) return false;  // from a joint: by algebra
  const Vector v = f.velocity;
  const Vector origin = cells_ ? origins_[0].point : f.start;
  const FlightScale scale = {cells_ ? origins_[0].scale.delta : f.start_error, norm_1(v), 0.0,
                             options_.filter_inflation};
  int best = -1;
  Quotient first{0.0, 1.0};
  for (const int disc : discs_) {
    if (disc == f.start_piece) continue;  // a line leaves a disc for good
    const PreparedCurve& w = *data_[at(disc)].shape;
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
    const PreparedCurve& w = *data_[at(best)].shape;
    if (w.kind == CurveKind::segment) {
      first = {geometry::fused_cross(w.tangent, origin - w.from),
               -geometry::fused_cross(w.tangent, v)};
    } else {
      const bool stands = best == f.start_piece;
      const Quadratic<double> q = quadratic<false>(w, origin, v, f.square_speed, 0.0, stands);
      first = straight_time(q, stands ? std::fabs(q.b) : std::sqrt(discriminant_of(q)));
    }
  }
  const double duration = first.time / first.unit;
  if (!(duration > 0.0 && duration < HUGE_VAL)) return false;  // too short a way for doubles
  ahead.kind = data_[at(best)].edge ? Ahead::Kind::edge : Ahead::Kind::wall;
  ahead.piece = best;
  ahead.root = 0;
  ahead.kappa = first.unit / first.time;
  ahead.duration = duration;
  return true;
}

}  // namespace carom
