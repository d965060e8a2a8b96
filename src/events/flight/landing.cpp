// Where a flight arrives: the hole, and the exact answer on which way a velocity points.
#include <algorithm>
#include <cmath>

#include "carom/base/error.hpp"
#include "events/flight/bounded.hpp"
#include "events/flight/crossing.hpp"
#include "events/flight/next_hit.hpp"

namespace carom {

using namespace geometry;

namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

double HitFinder::error_of(const Flight& f, const Ahead& ahead) const {
  return kappa_error_of(f, ahead.piece);
}

int HitFinder::hole_at(const Flight& f, const Ahead& ahead, double u,
                       DecisionCounts& counts) const {
  look_from(f);
  const PieceData& p = data_[at(ahead.piece)];
  const PreparedCurve& w = curves_[at(p.curve)];
  const Vector origin = origins_[at(p.offset)].point;
  const FlightScale& s = origins_[at(p.offset)].scale;
  const double d1 = norm_1(displacement(ahead.kappa, f.velocity, f.omega, 0.5));
  const double error = parameter_error(w, origin, d1, ahead.kappa, error_of(f, ahead), s);
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
    if (hole.from == 0.0 && hole.to >= end_parameter(wall.curve)) return h;  // all of the wall
    const double end = hole.to >= end_parameter(wall.curve) ? -1.0 : hole.to;
    if (exact.exit_within(ahead.piece, ahead.root, f.cell, hole.from, end, stands)) return h;
  }
  return -1;
}

Sign HitFinder::exactly_inward(int wall, double u, Vector v, DecisionCounts& counts) const {
  ++counts.exact;
  const Sign here = exact_->inward(wall, u, v);
  if (u > 0.0 || curves_[at(wall)].closed || here != Sign::positive) return here;
  return exact_->inward_at_end(table_.walls[at(wall)].previous, v);
}

}  // namespace carom
