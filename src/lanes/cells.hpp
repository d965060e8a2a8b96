// Straight flights among the discs of a lattice, each inside its cell: over edges of cells until a disc is met.
// Included by kernel.hpp inside the namespace of its instruction set.
//
// As in the scalar engine a particle does not move at an edge: its start is seen from the next cell. A disc that is
// met in this cell comes before any edge of it.

/// The cell of a flight, counted from the one it began in.
struct CellOf {
  Real first, second;
};

/// Where the start lies, seen from there.
INLINE Vector seen_from(const LaneTable& t, const Vector& start, const CellOf& cell) {
  return {start.x - (cell.first * t.lattice_x[0] + cell.second * t.lattice_x[1]),
          start.y - (cell.first * t.lattice_y[0] + cell.second * t.lattice_y[1])};
}

/// Cells from home; and the factor of what is as uncertain as the square of a distance.
INLINE Real way_of(const CellOf& cell) { return abs(cell.first) + abs(cell.second); }
INLINE Real doubts_at(const Real& way) { return fused(way, 0.125 * way, Real(1.0)); }

/// As seen from a cell of the lattice.
INLINE void look_from(View& f, const CellOf& cell) {
  const Real doubts = doubts_at(way_of(cell));
  f.roots = doubts * f.roots;
  f.order = doubts * f.order;
  const Mask home = cell.first == 0.0 && cell.second == 0.0;
  f.origin = seen_from(f.table, f.origin, cell);
  f.start_wall = choose(home, f.start_wall, Real(-1.0));
  f.start_piece = choose(home, f.start_piece, Real(-1.0));
}

/// The edge of the cell by which each line leaves it: between a corner on the right and the next one on the left.
struct Exit {
  Real edge;
  Mask certain;
};
template <int edges>
INLINE Exit exit_of_cell(const Real& sides, const auto& side_of_corner) {
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
INLINE void go_beyond(const LaneTable& t, const Real& edge, const Mask& crosses, CellOf& cell) {
  const Real beyond = max(edge, Real(0.0));
  where(crosses, cell.first) = cell.first + look_up<Reach::eight>(t.beyond_first, beyond);
  where(crosses, cell.second) = cell.second + look_up<Reach::eight>(t.beyond_second, beyond);
}
/// Follows the flights over a few edges: who meets a disc stays in its cell. The piece is -1 for those still on
/// their way.
INLINE Choice first_in_cells(View f, CellOf& cell) {
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
    look_from(f, cell);
    const Choice disc = first_of_all(f);
    where(under_way, found.piece) = disc.piece;
    found.decided = found.decided && (!under_way || disc.decided);
    under_way = under_way && disc.decided && disc.piece < 0.0;
    if (step == t.steps || !any_of(under_way)) return found;
    const Line line(f);
    const auto corner = [&](int i) { return line.side(t.edge_x[i], t.edge_y[i]); };
    const Exit exit = t.edges == 4 ? exit_of_cell<4>(f.sides, corner) : exit_of_cell<6>(f.sides, corner);
    found.decided = found.decided && (!under_way || exit.certain);
    under_way = under_way && exit.certain;
    go_beyond(t, exit.edge, under_way, cell);
    found.decided = found.decided && way_of(cell) <= LaneTable::farthest_cell;
  }
}

/// The same for one disc without holes, an edge at a time for all lanes: from cell to cell all signed areas of a flight
/// change by one number. This is what does not change.
struct Crossings {
  alignas(64) double corner[LaneTable::eight][LanePack::lanes];  ///< v x corner of the home cell
  double aside[LanePack::lanes], ahead[LanePack::lanes];         ///< v x and v . its disc's centre
  double across_first[LanePack::lanes], across_second[LanePack::lanes];  ///< v x and v . the lattice's vectors
  double along_first[LanePack::lanes], along_second[LanePack::lanes];
};

/// Who meets the disc of a cell, and who passes it: a line from outside meets it ahead exactly if it cuts it and comes
/// nearer. 1, -1; 0: not certain.
INLINE Real meets_disc(const View& f, const Real& aside, const Real& ahead, const Real& roots) {
  const Real discriminant = fused(aside, -aside, f.table.second_number[0] * f.square_speed);
  Real known(0.0);
  where(ahead < -f.sides || discriminant < -roots, known) = Real(-1.0);
  where(ahead > f.sides && discriminant > roots, known) = Real(1.0);
  return known;
}

INLINE void begin_crossings(const View& f, const CellOf& cell, Crossings& c, Real& known, int lane) {
  const LaneTable& t = f.table;
  const Line line(f);
  const Vector v = f.velocity, first{Real(t.lattice_x[0]), Real(t.lattice_y[0])}, second{Real(t.lattice_x[1]), Real(t.lattice_y[1])};
  for (int i = 0; i < t.edges; ++i) store(line.side(t.edge_x[i], t.edge_y[i]), c.corner[i] + lane);
  const Real aside = line.side(t.point_x[0], t.point_y[0]), ahead = line.ahead(t.point_x[0], t.point_y[0]);
  store(aside, c.aside + lane);
  store(ahead, c.ahead + lane);
  store(cross(v, first), c.across_first + lane);
  store(cross(v, second), c.across_second + lane);
  store(dot(v, first), c.along_first + lane);
  store(dot(v, second), c.along_second + lane);
  // The disc of this cell was asked for, but by those that begin off it.
  known = Real(-1.0);
  const Mask begins = f.start_wall < 0.0 && cell.first == 0.0 && cell.second == 0.0;
  if (any_of(begins)) [[unlikely]] where(begins, known) = meets_disc(f, aside, ahead, f.roots);
}

template <int edges>
INLINE void cross_edge(const View& f, CellOf& cell, const Crossings& c, Real& known, int lane) {
  const LaneTable& t = f.table;
  const Mask under_way = known < 0.0;
  const Real across_first = load(c.across_first + lane), across_second = load(c.across_second + lane);
  const auto shift = [&] { return fused(cell.first, across_first, cell.second * across_second); };
  const Real before = shift();
  const Exit exit = exit_of_cell<edges>(f.sides, [&](int i) { return load(c.corner[i] + lane) + before; });
  go_beyond(t, exit.edge, under_way, cell);
  const Real ahead = fused(cell.first, load(c.along_first + lane), fused(cell.second, load(c.along_second + lane), load(c.ahead + lane)));
  const Real way = way_of(cell);
  Real after = meets_disc(f, load(c.aside + lane) + shift(), ahead, doubts_at(way) * f.roots);
  where(!(exit.certain && way <= LaneTable::farthest_cell), after) = Real(0.0);
  where(under_way, known) = after;
}
