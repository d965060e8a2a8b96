// Straight flights among the discs of a lattice, each inside its cell: over edges of cells until
// a disc is met.
//
// As in the scalar engine a particle does not move at an edge: its start is seen from the next
// cell. A disc that is met in this cell comes before any edge of it.
#pragma once

#include "lanes/kernel/straight.hpp"

namespace carom::lanes {
namespace {

/// The cell of a flight, counted from the one it began in.
struct CellOf {
  Real first, second;
};

/// Where the start lies, seen from there.
CAROM_INLINE Vector seen_from(const LaneTable& t, const Vector& start, const CellOf& cell) {
  const Vector first{Real(t.lattice_x[0]), Real(t.lattice_y[0])},
      second{Real(t.lattice_x[1]), Real(t.lattice_y[1])};
  return geometry::less_multiples(start, cell.first, first, cell.second, second);
}

/// Cells from home; and the factor by which the error of a squared distance grows over so many.
CAROM_INLINE Real cells_from_home(const CellOf& cell) { return abs(cell.first) + abs(cell.second); }
CAROM_INLINE Real error_growth(const Real& cells) { return fused(cells, 0.125 * cells, Real(1.0)); }

/// The flight as seen from a cell of the lattice. A single disc was chosen with grown margins
/// already.
template <Kind kind>
CAROM_INLINE void look_from(View& f, const CellOf& cell) {
  f.origin = seen_from(f.table, f.origin, cell);
  if constexpr (kind.single) return;
  const Real growth = error_growth(cells_from_home(cell));
  f.roots = growth * f.roots;
  f.order = growth * f.order;
  const Mask home = cell.first == 0.0 && cell.second == 0.0;
  f.start_wall = choose(home, f.start_wall, Real(-1.0));
  f.start_piece = choose(home, f.start_piece, Real(-1.0));
}

/// The edge of the cell by which each line leaves it: between a corner on the right and the next
/// one on the left.
struct Exit {
  Real edge;
  Mask certain;
};
template <int edges>
CAROM_INLINE Exit exit_of_cell(const Real& sides, const auto& side_of_corner) {
  Real edge(-1.0);
  const Real first = side_of_corner(0);
  Real least = first;
  const Mask first_right = first < 0.0;
  Mask right = first_right;
  for (int i = 1; i < edges; ++i) {
    const Real side = side_of_corner(i);
    least = least_size(least, side);
    const Mask now = side < 0.0;
    where(right && !now, edge) = Real(counted[i - 1]);
    right = now;
  }
  where(right && !first_right, edge) = Real(counted[edges - 1]);
  return {edge, abs(least) > sides && edge >= 0.0};
}

/// Into the cell beyond that edge.
CAROM_INLINE void go_beyond(const LaneTable& t, const Real& edge, const Mask& crosses,
                            CellOf& cell) {
  const Real beyond = max(edge, Real(0.0));
  where(crosses, cell.first) = cell.first + look_up<Reach::eight>(t.beyond_first, beyond);
  where(crosses, cell.second) = cell.second + look_up<Reach::eight>(t.beyond_second, beyond);
}
/// Follows the flights over a few edges; a flight that meets a disc stays in its cell. The piece is
/// -1 for flights that have met none yet.
template <Kind kind>
CAROM_INLINE Choice first_in_cells(View f, CellOf& cell) {
  const LaneTable& t = f.table;
  const View start = f;
  Choice found{Real(-1.0), Mask(true), Real(0.0)};
  Mask under_way(true);
  for (int step = 0;; ++step) {
    f.origin = start.origin;
    f.start_wall = start.start_wall;
    f.start_piece = start.start_piece;
    f.roots = start.roots;
    f.order = start.order;
    look_from<kind>(f, cell);
    const Choice disc = first_of_all(f);
    where(under_way, found.piece) = disc.piece;
    found.decided = found.decided && (!under_way || disc.decided);
    under_way = under_way && disc.decided && disc.piece < 0.0;
    if (step == t.steps || !any_of(under_way)) return found;
    const Line line(f);
    const auto corner = [&](int i) { return line.side(t.edge_x[i], t.edge_y[i]); };
    const Exit exit =
        t.edges == 4 ? exit_of_cell<4>(f.sides, corner) : exit_of_cell<6>(f.sides, corner);
    found.decided = found.decided && (!under_way || exit.certain);
    under_way = under_way && exit.certain;
    go_beyond(t, exit.edge, under_way, cell);
    found.decided = found.decided && cells_from_home(cell) <= LaneTable::farthest_cell;
  }
}

/// Does a flight meet the disc of the cell in which it begins? A line from outside meets it ahead
/// exactly if it cuts it and comes nearer. 1: yes; -1: no; 0: not certain.
CAROM_INLINE Real meets_disc(const View& f, const Real& aside, const Real& ahead,
                             const Real& roots) {
  const Real discriminant = fused(aside, -aside, f.table.second_number[0] * f.square_speed);
  Real known(0.0);
  where(ahead < -f.sides || discriminant < -roots, known) = Real(-1.0);
  where(ahead > f.sides && discriminant > roots, known) = Real(1.0);
  return known;
}

/// The edge where the edges by which lines of a direction leave a cell begin: those along which a
/// point goes to the left. Of two opposite edges it is one, so they follow each other.
struct ForwardEdges {
  Real edge;
  Mask certain;
};
CAROM_INLINE ForwardEdges forward_edges(const LaneTable& t, const View& f) {
  constexpr int edges = 6, half = 3;
  Mask leaves[half];
  Real least(__builtin_huge_val());
  for (int i = 0; i < half; ++i) {
    const Real leftwards =
        fused(f.velocity.x, Real(t.edge_along_y[i]), -f.velocity.y * t.edge_along_x[i]);
    leaves[i] = leftwards > 0.0;
    least = least_size(least, leftwards);
  }
  Real edge(0.0);
  Mask before = !leaves[half - 1];
  for (int i = 0; i < edges; ++i) {
    const Mask now = i < half ? leaves[i] : !leaves[i - half];
    where(now && !before, edge) = Real(counted[i]);
    before = now;
  }
  return {edge, least > f.sides};
}

/// `meets`: the line met a disc; `goes_on`: it has met none yet; neither: not certain.
struct Crossed {
  Mask meets, goes_on;
};

/// Flights among hexagons with one disc each, in two stages. The corners between forward edges tell
/// by which of them a line leaves a cell; from cell to cell their sides, and the centre's, change
/// by one number for each edge.
struct HexagonCrossings {
  static constexpr int edges = 6, forward = 3;
  alignas(LanePack::alignment) double edge[LanePack::lanes], aside[LanePack::lanes];
  double jump[forward][LanePack::lanes], side[forward - 1][LanePack::lanes];
  double
      known[LanePack::lanes];  ///< 1: meets the disc of its first cell; -1: goes on; 0: not certain
};

CAROM_INLINE Real next_edge(const Real& edge) {
  return choose(edge == Real(counted[HexagonCrossings::edges - 1]), Real(0.0), edge + 1.0);
}

CAROM_INLINE void begin_hexagons(const View& f, const CellOf& cell, HexagonCrossings& c, int lane) {
  constexpr int forward = HexagonCrossings::forward;
  const LaneTable& t = f.table;
  const Line line(f);
  const Vector v = f.velocity;
  const ForwardEdges begin = forward_edges(t, f);
  // From the home cell to this one.
  const Real across_first = fused(v.x, Real(t.lattice_y[0]), -v.y * t.lattice_x[0]);
  const Real across_second = fused(v.x, Real(t.lattice_y[1]), -v.y * t.lattice_x[1]);
  const Real so_far = fused(cell.first, across_first, cell.second * across_second);
  Real edge = begin.edge;
  store(edge, c.edge + lane);
  for (int i = 0; i < forward; ++i) {
    const Real x = look_up<Reach::eight>(t.beyond_x, edge),
               y = look_up<Reach::eight>(t.beyond_y, edge);
    store(fused(v.x, y, -v.y * x), c.jump[i] + lane);
    if (i + 1 == forward) break;
    edge = next_edge(edge);
    const Real px = look_up<Reach::eight>(t.edge_x, edge),
               py = look_up<Reach::eight>(t.edge_y, edge);
    store(fused(line.x, py, fused(line.minus_y, px, line.offset)) + so_far, c.side[i] + lane);
  }
  const Real aside = line.side(t.point_x[0], t.point_y[0]);
  store(aside + so_far, c.aside + lane);
  Real known =
      choose(begin.certain && cells_from_home(cell) + 2.0 * t.steps <= LaneTable::farthest_cell,
             Real(-1.0), Real(0.0));
  // The disc of this cell was asked for, but by those that begin off it.
  const Mask off = f.start_wall < 0.0;
  if (any_of(off)) [[unlikely]] {
    const Mask begins = off && cell.first == 0.0 && cell.second == 0.0 && known < 0.0;
    where(begins, known) = meets_disc(f, aside, line.ahead(t.point_x[0], t.point_y[0]), f.roots);
  }
  store(known, c.known + lane);
}

/// Over some edges. The disc of a cell that was entered lies ahead, if the line cuts it.
CAROM_INLINE Crossed end_hexagons(const View& f, const HexagonCrossings& c, CellOf& cell,
                                  int lane) {
  constexpr int forward = HexagonCrossings::forward;
  const LaneTable& t = f.table;
  Real jump[forward], side[forward - 1], crossed[forward], edges_crossed(0.0);
  for (int i = 0; i < forward; ++i) {
    jump[i] = load(c.jump[i] + lane);
    crossed[i] = Real(0.0);
    if (i + 1 < forward) side[i] = load(c.side[i] + lane);
  }
  const Real roots = error_growth(cells_from_home(cell) + 2.0 * t.steps) * f.roots,
             square = t.second_number[0] * f.square_speed;
  Real aside = load(c.aside + lane), known = load(c.known + lane);
  Mask meets = known > 0.0, under_way = known < 0.0;
  for (int step = 0; step < t.steps; ++step) {
    Real least = side[0], by = jump[forward - 1];
    Mask here = under_way;  // not by an edge before
    for (int i = 0; i + 1 < forward; ++i) {
      if (i > 0) least = least_size(least, side[i]);
      const Mask left = side[i] > 0.0;
      where(here && left, crossed[i]) = crossed[i] + 1.0;
      if (i + 2 < forward) here = here && !left;
    }
    for (int i = forward - 2; i >= 0; --i) where(side[i] > 0.0, by) = jump[i];
    where(under_way, edges_crossed) = edges_crossed + 1.0;
    under_way = under_way && abs(least) > f.sides;
    aside = aside + by;
    for (Real& s : side) s = s + by;
    const Real discriminant = fused(aside, -aside, square);
    meets = meets || (under_way && discriminant > roots);
    under_way = under_way && discriminant < -roots;
  }
  crossed[forward - 1] = edges_crossed;
  for (int i = 0; i + 1 < forward; ++i) crossed[forward - 1] = crossed[forward - 1] - crossed[i];
  Real edge = load(c.edge + lane);
  for (int i = 0; i < forward; ++i) {
    if (i > 0) edge = next_edge(edge);
    cell.first = fused(crossed[i], look_up<Reach::eight>(t.beyond_first, edge), cell.first);
    cell.second = fused(crossed[i], look_up<Reach::eight>(t.beyond_second, edge), cell.second);
  }
  return {meets, under_way};
}

}  // namespace
}  // namespace carom::lanes
