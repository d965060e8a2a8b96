#include "events/step/group_hit.hpp"

#include <algorithm>
#include <cmath>

namespace carom::events {

using geometry::Vector;

namespace {

/// The corner that begins a wall: one of pi/n leaves a unique direction, which the hits on both
/// walls come to.
bool is_regular(const PieceTable& pieces, int wall) {
  const Wall& w = pieces.table.walls[static_cast<std::size_t>(wall)];
  if (w.next == wall) return true;
  return w.corner > 0 || pieces.exact->corner(w.previous, wall).order > 0;
}

}  // namespace

GroupHit hit_of(const PieceTable& pieces, const Table& table, const Group& group,
                std::size_t member, const Barrier<double>& barrier, DecisionCounts& counts) {
  GroupHit hit;
  geometry::Cell cell = group.state(member).cell;
  cell.first += barrier.cell.first;
  cell.second += barrier.cell.second;
  Vector x = group.phase().position[member];
  if (table.lattice) x = x - table.lattice->translation(barrier.cell);
  const geometry::PreparedCurve& curve = pieces.curve(barrier.wall);
  geometry::PreparedCurve::Frame frame = curve.settle(x);
  const double u = curve.parameter(frame.point);
  if (u == curve.last() || u == geometry::first_parameter) frame = curve.frame(u);
  hit.before = group.phase().velocity[member];
  hit.state = {barrier.wall, u, frame.point, hit.before, cell, group.time()};
  for (const int h : table.walls[static_cast<std::size_t>(barrier.wall)].holes) {
    const Hole& hole = table.holes[static_cast<std::size_t>(h)];
    if (!(hole.from <= u && u < hole.to)) continue;
    hit.hole = h;
    return hit;
  }
  Vector after = geometry::reflected(hit.before, frame.normal, frame.square, frame.k, 0.0);
  Sign inward = pieces.inward(barrier.wall, u, after, frame.normal, counts);
  if (inward == Sign::negative) {  // a grazing rounding: reflecting once more turns it back
    after = geometry::reflected(after, frame.normal, frame.square, frame.k, 0.0);
    inward = pieces.inward(barrier.wall, u, after, frame.normal, counts);
  }
  hit.state.velocity = after;
  const Vector& there = group.phase().position[member];
  using End = Barrier<double>::End;
  const bool regular =
      (!barrier.begins_wall || !barrier.is_at(End::from, there) ||
       is_regular(pieces, barrier.wall)) &&
      (!barrier.ends_wall || !barrier.is_at(End::to, there) ||
       is_regular(pieces, pieces.table.walls[static_cast<std::size_t>(barrier.wall)].next));
  hit.inward =
      inward == Sign::positive && regular && !barrier.is_thin(there) && !group.next().slides;
  return hit;
}

bool on_some_wall(const std::vector<Barrier<double>>& barriers, int walls, Vector x) {
  return std::any_of(barriers.begin(), barriers.end(), [&](const Barrier<double>& b) {
    return b.wall < walls && b.covers(x) && std::fabs(b.gap(x)) <= b.on_wall() * b.rounding(x);
  });
}

bool meets_some_wall(const std::vector<Barrier<double>>& barriers, int walls, Vector from,
                     Vector to) {
  return std::any_of(barriers.begin(), barriers.end(), [&](const Barrier<double>& b) {
    if (b.wall >= walls || !(b.covers(from) || b.covers(to))) return false;
    const double first = b.gap(from), last = b.gap(to);
    return !(std::min(first, last) > b.slack) && !(std::max(first, last) < -b.slack);
  });
}

}  // namespace carom::events
