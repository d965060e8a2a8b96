// Where a flight begins and where it arrives: the cell, the hole, and the exact answer on which way
// a velocity points.
#include <cmath>

#include "base/index.hpp"
#include "events/flight/bounded.hpp"
#include "events/flight/crossing.hpp"
#include "events/flight/piece_table.hpp"

namespace carom::events {

using namespace geometry;

namespace {

using base::at;

}  // namespace

int PieceTable::hole_at(const Flight& f, const Ahead& ahead, double u,
                        DecisionCounts& counts) const {
  const PieceData& p = data[at(ahead.piece)];
  const Origin origin = origin_of(f, p.offset);
  const double d1 = norm_1(displacement(ahead.kappa, f.velocity, f.omega, 0.5));
  const double error =
      parameter_error(*p.shape, origin.point, d1, ahead.kappa, error_of(f, ahead), origin.scale);
  const Wall& wall = table.walls[at(p.wall)];
  // Where hits are found by the flight's line (PreparedCurve::arrival_by_line) a grazing one errs
  // by more.
  bool decided = !p.shape->thin() && (p.kind == CurveKind::segment || error < longest_step);
  int inside = -1;
  for (const int h : wall.holes) {
    const Hole& hole = table.holes[at(h)];
    const Sign first = sign_within(u - hole.from, error), last = sign_within(hole.to - u, error);
    if (!decided) break;
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
  const ExactFlight flight = exact_flight(f);
  const bool on_wall = is_on(f, ahead.piece);
  for (const int h : wall.holes) {
    const Hole& hole = table.holes[at(h)];
    if (hole.from == 0.0 && hole.to >= end_parameter(wall.curve)) return h;  // all of the wall
    const double end = hole.to >= end_parameter(wall.curve) ? -1.0 : hole.to;
    if (flight.exit_within(ahead.piece, ahead.root, f.cell, hole.from, end, on_wall)) return h;
  }
  return -1;
}

Sign PieceTable::exactly_inward(int wall, double u, Vector v, DecisionCounts& counts) const {
  ++counts.exact;
  const Sign here = exact->inward(wall, u, v);
  if (u > 0.0 || curves[at(wall)].closed || here != Sign::positive) return here;
  return exact->inward_at_end(table.walls[at(wall)].previous, v);
}

bool PieceTable::surely_inside(Vector point) const {
  if (!convex || enclosure.size() < 3) return false;
  if (!(norm_1(point - curves.front().from) < enclosure.diameter())) return false;
  for (int i = 0; i < enclosure.size(); ++i) {
    const PreparedCurve& w = curves[at(i)];
    if (!(geometry::cross(w.to - w.from, point - w.from) > inside_bound)) return false;
  }
  return true;
}

/// The edge that the flight crosses without moving: its start lies beyond it, or on it and on its
/// way out. The tie rule is that of the joints: a point on the flight counts as lying on its left.
int PieceTable::edge_crossed_at_start(const Flight& f) const {
  const Origin origin = origin_of(f, 0);
  for (int i = first_edge; i < static_cast<int>(data.size()); ++i) {
    const PreparedCurve& w = curves[at(data[at(i)].curve)];
    const Vector e = origin.point - w.from;
    const double side = geometry::cross(w.tangent, e);
    const double bound = line_error(origin.scale, std::fabs(e.x) + std::fabs(e.y)).a;
    Sign sign = sign_within(side, bound);
    if (sign == Sign::undecided) sign = exact_flight(f).left_of(i, f.cell);
    if (sign == Sign::positive) continue;
    if (sign == Sign::negative) return i;
    Sign out = exact->inward(i, 0.0, f.velocity);
    if (out == Sign::zero) {
      const bool along = dot(w.direction, f.velocity) > 0;  // parallel: the sign is certain
      out = (f.omega == 0.0 ? along : (f.omega > 0) == along) ? Sign::negative : Sign::positive;
    }
    if (out == Sign::negative) return i;
  }
  return -1;
}

/// The piece that the particle is on, seen from the flight's cell.
void PieceTable::find_start(Flight& f) const {
  f.start_piece = f.wall;  // the pieces begin with the walls in their own cell
  f.start_previous = -1;
  if (f.wall < 0) return;
  if (!(f.cell == Cell{})) {
    f.start_piece = -1;
    if (!displaced) return;
    const auto [first, end] = shared_->images.equal_range(f.wall);
    for (auto image = first; image != end; ++image) {
      const Cell o = offsets[at(data[at(image->second)].offset)];
      if (o.first == -f.cell.first && o.second == -f.cell.second) f.start_piece = image->second;
    }
  }
  if (f.u != 0.0 || f.start_piece < 0 || curves[at(f.wall)].closed) return;
  f.start_previous = data[at(f.start_piece)].previous;
}

void PieceTable::begin(Flight& f) const {
  f.entry = -1;
  if (cells && first_edge < static_cast<int>(data.size())) {
    for (;;) {
      const int edge = edge_crossed_at_start(f);
      if (edge < 0) break;
      const Cell beyond = table.lattice->edges[at(edge - first_edge)].beyond;
      f.cell.first += beyond.first;
      f.cell.second += beyond.second;
    }
  }
  find_start(f);
}

bool PieceTable::in_cell(const Flight& f) const { return edge_crossed_at_start(f) < 0; }

void PieceTable::cross(Flight& f, const Ahead& ahead) const {
  cross_edge(f, ahead.piece);
  find_start(f);
}

}  // namespace carom::events
