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

/// As seen from a cell of the lattice.
INLINE void look_from(View& f, const CellOf& cell) {
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
INLINE Exit exit_of_cell(const LaneTable& t, const Real& sides, const auto& side_of_corner) {
  Real edge(-1.0);
  const Real first = side_of_corner(0);
  Real least = first;
  const Mask first_right = first < 0.0;
  Mask right = first_right;
  for (int i = 1; i < t.edges; ++i) {
    const Real side = side_of_corner(i);
    least = least_size(least, side);
    const Mask now = side < 0.0;
    where(right && !now, edge) = Real(counted[i - 1]);
    right = now;
  }
  where(right && !first_right, edge) = Real(counted[t.edges - 1]);
  return {edge, abs(least) > sides && edge >= 0.0};
}

/// Into the cell beyond that edge.
INLINE void go_beyond(const LaneTable& t, const Real& edge, const Mask& crosses, CellOf& cell) {
  const Real beyond = max(edge, Real(0.0));
  where(crosses, cell.first) = cell.first + look_up<Reach::eight>(t.beyond_first, beyond);
  where(crosses, cell.second) = cell.second + look_up<Reach::eight>(t.beyond_second, beyond);
}
/// What is rounded in a translation grows with the cells.
INLINE Mask near(const CellOf& cell) { return abs(cell.first) + abs(cell.second) <= LaneTable::farthest_cell; }

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
    look_from(f, cell);
    const Choice disc = first_of_all(f);
    where(under_way, found.piece) = disc.piece;
    found.decided = found.decided && (!under_way || disc.decided);
    under_way = under_way && disc.decided && disc.piece < 0.0;
    if (step == t.steps || !any_of(under_way)) return found;
    const Line line(f);
    const Exit exit = exit_of_cell(t, f.sides, [&](int i) { return line.side(t.edge_x[i], t.edge_y[i]); });
    found.decided = found.decided && (!under_way || exit.certain);
    under_way = under_way && exit.certain;
    go_beyond(t, exit.edge, under_way, cell);
    found.decided = found.decided && near(cell);
  }
}

/// The same for one disc without holes: a line from outside meets it ahead exactly if it cuts it and comes nearer. From
/// cell to cell all signed areas change by one number.
INLINE Choice only_disc_in_cells(const View& f, CellOf& cell) {
  const LaneTable& t = f.table;
  const Line line(f);
  const Vector v = f.velocity, to_centre{t.point_x[0] - f.origin.x, t.point_y[0] - f.origin.y};
  const Vector first{Real(t.lattice_x[0]), Real(t.lattice_y[0])}, second{Real(t.lattice_x[1]), Real(t.lattice_y[1])};
  const Real aside_first = cross(v, first), aside_second = cross(v, second);
  const Real ahead_first = dot(v, first), ahead_second = dot(v, second);
  const Real aside_home = cross(v, to_centre), ahead_home = dot(v, to_centre);
  const Real reach = t.second_number[0] * f.square_speed;
  Real corners[LaneTable::eight];
  for (int i = 0; i < t.edges; ++i) corners[i] = line.side(t.edge_x[i], t.edge_y[i]);
  Mask decided(true), under_way(true), met(false);
  Mask stands = f.start_wall == 0.0 && cell.first == 0.0 && cell.second == 0.0;
  for (int step = 0;; ++step) {
    const Real shift = fused(cell.first, aside_first, cell.second * aside_second);
    const Real aside = aside_home + shift, ahead = fused(cell.first, ahead_first, fused(cell.second, ahead_second, ahead_home));
    const Real discriminant = fused(aside, -aside, reach);
    const Mask meets = under_way && !stands && ahead > f.sides && discriminant > f.roots;
    const Mask misses = under_way && (stands || ahead < -f.sides || discriminant < -f.roots);
    met = met || meets;
    decided = decided && (!under_way || meets || misses);
    under_way = misses;
    if (step == t.steps || !any_of(under_way)) return {choose(met, Real(0.0), Real(-1.0)), decided, Real(0.0)};
    const Exit exit = exit_of_cell(t, f.sides, [&](int i) { return corners[i] + shift; });
    decided = decided && (!under_way || exit.certain);
    under_way = under_way && exit.certain;
    go_beyond(t, exit.edge, under_way, cell);
    decided = decided && near(cell);
    stands = Mask(false);
  }
}
