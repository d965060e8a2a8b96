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

/// One disc alone, without holes: a line from outside meets it ahead exactly if it cuts it and comes nearer. The
/// line passes its centre at `aside` and meets it `ahead`, both times the speed.
INLINE Choice meets_disc(const View& f, const Real& aside, const Real& ahead) {
  const Real discriminant = fused(Real(f.table.second_number[0]), f.square_speed, -(aside * aside));
  const Mask stands = f.start_wall == Real(0.0);
  const Mask leaves = !stands && ahead > f.sides && discriminant > f.roots;
  Real piece(-1.0);
  where(leaves, piece) = Real(0.0);
  return {piece, leaves || stands || ahead < -f.sides || discriminant < -f.roots, Real(0.0)};
}

/// Follows the flights over a few edges: who meets a disc stays in its cell. The piece is -1 for those still on
/// their way; `f` is left as seen from the cell.
INLINE Choice first_in_cells(View& f, CellOf& cell) {
  const LaneTable& t = f.table;
  const Vector start = f.origin;
  const Real wall = f.start_wall, piece = f.start_piece;
  const Real none(-1.0);
  Choice found{none, Mask(true), Real(0.0)};
  Mask under_way(true);
  for (int step = 0;; ++step) {
    f.origin = seen_from(t, start, cell);
    const Mask home = cell.first == 0.0 && cell.second == 0.0;
    f.start_wall = choose(home, wall, none);
    f.start_piece = choose(home, piece, none);
    const Line line(f);
    const Vector e{t.point_x[0] - f.origin.x, t.point_y[0] - f.origin.y};
    const Choice disc = t.pieces == 1 ? meets_disc(f, cross(f.velocity, e), dot(f.velocity, e)) : first_of_all(f);
    where(under_way, found.piece) = disc.piece;
    found.decided = found.decided && (!under_way || disc.decided);
    under_way = under_way && disc.decided && disc.piece < 0.0;
    if (step == t.steps || !any_of(under_way)) return found;

    Real edge = none;
    const Real first = line.side(t.edge_x[0], t.edge_y[0]);
    Real least = first;
    const Mask first_right = first < 0.0;
    Mask right = first_right;
    for (int i = 1; i < t.edges; ++i) {
      const Real side = line.side(t.edge_x[i], t.edge_y[i]);
      least = least_size(least, side);
      const Mask now = side < 0.0;
      where(right && !now, edge) = Real(counted[i - 1]);
      right = now;
    }
    where(right && !first_right, edge) = Real(counted[t.edges - 1]);
    const Mask certain = abs(least) > f.sides && edge >= 0.0;
    found.decided = found.decided && (!under_way || certain);
    under_way = under_way && certain;
    const Real beyond = max(edge, Real(0.0));
    where(under_way, cell.first) = cell.first + look_up<Reach::eight>(t.beyond_first, beyond);
    where(under_way, cell.second) = cell.second + look_up<Reach::eight>(t.beyond_second, beyond);
    // What is rounded in a translation grows with the cells.
    found.decided = found.decided && abs(cell.first) + abs(cell.second) <= LaneTable::farthest_cell;
  }
}
