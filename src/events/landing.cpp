// Where a flight arrives: wall, parameter, hole, and which way a velocity points there.
#include <algorithm>
#include <cmath>

#include "carom/base/error.hpp"
#include "events/next_hit.hpp"

namespace carom {

using namespace geometry;

namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }
double norm_1(Vector v) { return std::fabs(v.x) + std::fabs(v.y); }

}  // namespace

HitFinder::Landing HitFinder::land(const Flight& f, const Ahead& ahead, DecisionCounts& counts) const {
  look_from(f);  // the view may be another particle's
  const PieceData& p = data_[at(ahead.piece)];
  const PreparedCurve& w = curves_[at(p.curve)];
  const Vector origin = origins_[at(p.offset)].point;
  Landing landing;
  landing.wall = p.wall;
  const Cell o = offsets_[at(p.offset)];
  landing.cell = {f.cell.first + o.first, f.cell.second + o.second};
  landing.velocity = f.omega == 0.0 ? f.velocity : turned(ahead.kappa, f.velocity, f.omega, 0.5);
  if (ahead.kind == Ahead::Kind::joint) return landing;
  if (f.omega == 0.0 && w.kind == CurveKind::segment) {
    // By the sides of the two joints: inside [0, 1] however flat the flight.
    const double from = geometry::cross(f.velocity, w.from - origin);
    const double to = geometry::cross(f.velocity, w.to - origin);
    landing.u = w.clamp(from / (from - to));
  } else {
    landing.u = w.parameter(origin + displacement(ahead.kappa, f.velocity, f.omega, 0.5));
  }
  if (!table_.walls[at(p.wall)].holes.empty()) landing.hole = hole_at(f, ahead, landing.u, counts);
  return landing;
}

double HitFinder::error_of(const Flight& f, const Ahead& ahead) const {
  return kappa_error_of(f, ahead.piece);
}

int HitFinder::hole_at(const Flight& f, const Ahead& ahead, double u, DecisionCounts& counts) const {
  const PieceData& p = data_[at(ahead.piece)];
  const PreparedCurve& w = curves_[at(p.curve)];
  const Vector origin = origins_[at(p.offset)].point;
  const FlightScale& s = origins_[at(p.offset)].scale;
  double error = HUGE_VAL;  // of u
  if (w.kind == CurveKind::segment && f.omega == 0.0) {
    const double from = 2.0 * geometry::cross(f.velocity, w.from - origin);
    const double to = 2.0 * geometry::cross(f.velocity, w.to - origin);
    const double sum = side_error(s, norm_1(w.from - origin)) + side_error(s, norm_1(w.to - origin));
    const double width = std::fabs(from - to) - sum;
    if (width > 0.0) error = 2.0 * sum / width + 3.1 * unit_roundoff;
  } else {
    const double d1 = norm_1(displacement(ahead.kappa, f.velocity, f.omega, 0.5));
    const double x = point_error(s, ahead.kappa, error_of(f, ahead), d1) +
                     s.inflation * (w.centre_error + unit_roundoff * (2.1 * norm_1(origin) + 2.1 * d1 + 2.1 * w.extent));
    // The map of the point to u stretches by at most 1 / length, or by the rows of the map to the unit
    // circle, on which the half-angle tangent grows by at most 1.
    const double row = w.kind == CurveKind::segment ? 1.42 * w.inverse_length
                                                    : norm_1(w.along) + norm_1(w.across);
    error = 1.01 * row * x + s.inflation * 16.0 * unit_roundoff;
  }
  const Wall& wall = table_.walls[at(p.wall)];
  bool decided = true;
  int inside = -1;
  for (const int h : wall.holes) {
    const Hole& hole = table_.holes[at(h)];
    const Sign first = sign_within(u - hole.from, error), last = sign_within(hole.to - u, error);
    if (first == Sign::negative || last == Sign::negative) continue;
    if (first == Sign::positive && last == Sign::positive) {
      inside = h;
      continue;
    }
    decided = false;
  }
  if (decided) {
    ++counts.filter;
    return inside;
  }
  ++counts.exact;
  const ExactFlight exact = exact_flight(f);
  const bool stands = stands_on(f, ahead.piece);
  for (const int h : wall.holes) {
    const Hole& hole = table_.holes[at(h)];
    const double end = hole.to >= end_parameter(wall.curve) ? -1.0 : hole.to;
    if (exact.exit_within(ahead.piece, ahead.root, f.cell, hole.from, end, stands)) return h;
  }
  return -1;
}

Sign HitFinder::inward(int wall, double u, Vector v, Vector n, DecisionCounts& counts) const {
  const PreparedCurve& w = curves_[at(wall)];
  if (u > 0.0) {
    // Segment: the tangent errs by 4u. Conics: e = x - centre errs by 12u of |a|_1 + |b|_1 a coordinate,
    // which the rows of the map to the unit circle turn into a relative error of the gradient.
    const double bound = options_.filter_inflation * w.normal_error * norm_1(v);
    const Sign sign = sign_within(dot(n, v), bound);
    if (sign != Sign::undecided) {
      ++counts.filter;
      return sign;
    }
  }
  ++counts.exact;
  const Sign here = exact_->inward(wall, u, v);
  if (u > 0.0 || w.closed || here != Sign::positive) return here;
  return exact_->inward_at_end(table_.walls[at(wall)].previous, v);
}

}  // namespace carom
