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

/// One disc alone, without holes: a line from outside meets it ahead exactly if it cuts it and comes nearer.
INLINE Choice meets_disc(const View& f) {
  const LaneTable& t = f.table;
  const Vector e{f.origin.x - t.point_x[0], f.origin.y - t.point_y[0]};
  const Real p = dot(e, e) - t.second_number[0], q = dot(e, f.velocity);
  const Real discriminant = q * q - p * f.square_speed;
  const Real sides = (sign_margin * t.size) * f.speed, roots = (sides * t.size) * f.speed;
  const Mask stands = f.start_wall == Real(0.0);
  const Mask leaves = !stands && q < -sides && discriminant > roots;
  Real piece(-1.0);
  where(leaves, piece) = Real(0.0);
  return {piece, leaves || stands || q > sides || discriminant < -roots, Real(0.0)};
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
    const Choice disc = t.pieces == 1 ? meets_disc(f) : first_of_all(f);
    where(under_way, found.piece) = disc.piece;
    found.decided = found.decided && (!under_way || disc.decided);
    under_way = under_way && disc.decided && disc.piece < 0.0;
    if (step == t.steps || !any_of(under_way)) return found;

    Real edge = none, least(__builtin_huge_val());
    const auto side_of = [&](int i) { return cross(f.velocity, Vector{t.edge_x[i] - f.origin.x, t.edge_y[i] - f.origin.y}); };
    const Real first = side_of(0);
    Real before = first;
    for (int i = 0; i < t.edges; ++i) {
      const Real side = i + 1 == t.edges ? first : side_of(i + 1);
      least = min(least, abs(side));
      where(before < 0.0 && side >= 0.0, edge) = Real(static_cast<double>(i));
      before = side;
    }
    const Mask certain = least > (sign_margin * t.size) * f.speed && edge >= 0.0;
    found.decided = found.decided && (!under_way || certain);
    under_way = under_way && certain;
    const Real beyond = max(edge, Real(0.0));
    where(under_way, cell.first) = cell.first + look_up<Reach::few>(t.beyond_first, beyond);
    where(under_way, cell.second) = cell.second + look_up<Reach::few>(t.beyond_second, beyond);
    // What is rounded in a translation grows with the cells.
    found.decided = found.decided && abs(cell.first) + abs(cell.second) <= LaneTable::farthest_cell;
  }
}
