// The first stages of a hit of every lane: which wall, and the flight to it. Each stage passes over all lanes before the
// next one begins, so that roots and divisions of several registers are under way together: a core looks
// ahead by some hundred instructions, and a whole hit is longer than that. Included by kernel.hpp inside the
// namespace of its instruction set.

/// What one stage leaves to the next one.
struct Stages {
  alignas(64) double piece[LanePack::lanes];
  double known[LanePack::lanes];  ///< 1: decided, 0: not, -1: no wall follows (in this cell)
  double kappa[LanePack::lanes];  ///< of Larmor circles
  double duration[LanePack::lanes];  ///< not a number: undecided
  double cell_first[LanePack::lanes], cell_second[LanePack::lanes];
  double start_x[LanePack::lanes], start_y[LanePack::lanes];  ///< of the flight, seen from that cell
  double high[LanePack::lanes], low[LanePack::lanes];  ///< time there, of those that wait for an answer
};

/// The flights from their last hits.
template <class Kind>
INLINE View view_of(const LaneTable& t, const LanePack& pack, int lane) {
  View f{t, {load(pack.x + lane), load(pack.y + lane)}, {load(pack.vx + lane), load(pack.vy + lane)},
         load(pack.piece + lane), Real(0.0), load(pack.speed + lane), load(pack.square_speed + lane),
         load(pack.sides + lane), load(pack.roots + lane), load(pack.order + lane), Real(0.0), Real(0.0), Real(0.0), Real(0.0)};
  if constexpr (Kind::turn != 0) {
    f.omega = load(pack.omega + lane);
    f.inverse_half = load(pack.inverse_half + lane);
    f.pace = load(pack.pace + lane);
    f.joint_margin = load(pack.joint_margin + lane);
  }
  f.start_wall = f.start_piece;
  if (t.divided) where(f.start_piece >= 0.0, f.start_wall) = look_up<Kind::reach>(t.wall, max(f.start_piece, Real(0.0)));
  return f;
}

template <class Kind>
INLINE void choose_piece(const LaneTable& t, LanePack& pack, Stages& stages, int lane) {
  constexpr bool larmor = Kind::turn != 0;
  View f = view_of<Kind>(t, pack, lane);
  Choice choice;
  Real known;
  if constexpr (Kind::cells) {
    CellOf cell{load(pack.cell_first + lane), load(pack.cell_second + lane)};
    choice = first_in_cells<Kind>(f, cell);
    known = choose(choice.piece < 0.0, Real(-1.0), Real(1.0));
    store(cell.first, stages.cell_first + lane);
    store(cell.second, stages.cell_second + lane);
  } else {
    if constexpr (larmor)
      choice = Kind::convex ? exit_of_loop_by_circle<Kind::turn, Kind>(f) : first_of_all_by_circle<Kind::turn, Kind>(f);
    else
      choice = Kind::convex ? exit_of_loop<Kind>(f) : first_of_all<Kind::ellipses>(f);
    known = Real(1.0);
    if constexpr (!Kind::convex && !larmor) where(choice.piece < 0.0, known) = Real(t.open ? -1.0 : 0.0);
  }
  where(!choice.decided, known) = Real(0.0);
  store(known, stages.known + lane);
  if constexpr (!Kind::single) store(max(choice.piece, Real(0.0)), stages.piece + lane);
  if constexpr (larmor && !Kind::convex) store(choice.kappa, stages.kappa + lane);
}

/// The same where the only piece is one disc in each cell.
template <class Kind, int edges>
INLINE void choose_cells(const LaneTable& t, const LanePack& pack, Stages& stages) {
  Crossings crossings;
  for (int lane = 0; lane < pack.used; lane += width)
    begin_crossings<edges>(view_of<Kind>(t, pack, lane), {load(pack.cell_first + lane), load(pack.cell_second + lane)}, crossings, lane);
  for (int lane = 0; lane < pack.used; lane += width) {
    CellOf cell{load(pack.cell_first + lane), load(pack.cell_second + lane)};
    store(cross_edges<edges>(view_of<Kind>(t, pack, lane), crossings, cell, lane), stages.known + lane);
    store(cell.first, stages.cell_first + lane);
    store(cell.second, stages.cell_second + lane);
  }
}

/// The piece that was chosen.
template <class Kind>
INLINE Real chosen(const Stages& stages, int lane) {
  return Kind::single ? Real(0.0) : load(stages.piece + lane);
}

/// What is needed of it.
template <class Kind>
INLINE Met met_by(const View& f, const Real& piece) {
  const LaneTable& t = f.table;
  const auto of = [&](const double* numbers) { return number_of<Kind>(numbers, piece); };
  Met met{{of(t.point_x), of(t.point_y)}, of(t.first_number), of(t.second_number),
          Real(0.0), Real(1.0), Real(1.0), Mask(Kind::circles || Kind::ellipses), Mask(Kind::alone)};
  if constexpr (Kind::circles || Kind::ellipses) {
    met.into = of(t.into);
    met.orientation = Kind::convex ? Real(1.0) : of(t.orientation);
    met.strength = of(t.strength);
    if constexpr (Kind::segments) met.bent = Kind::convex ? met.into < 0.0 : met.orientation != 0.0;
  }
  if constexpr (Kind::ellipses) met.ellipse = ellipse_met_by<Kind>(t, piece);
  if constexpr (!Kind::alone && !(Kind::cells && Kind::single) && (Kind::circles || Kind::ellipses || Kind::convex || Kind::turn != 0)) met.stands = (t.divided ? of(t.wall) : piece) == f.start_wall;
  return met;
}

template <class Kind>
INLINE void meet(const LaneTable& t, const LanePack& pack, Stages& stages, int lane) {
  View f = view_of<Kind>(t, pack, lane);
  if constexpr (Kind::cells) {
    look_from<Kind>(f, {load(stages.cell_first + lane), load(stages.cell_second + lane)});
    store(f.origin.x, stages.start_x + lane);
    store(f.origin.y, stages.start_y + lane);
  }
  const Met met = met_by<Kind>(f, chosen<Kind>(stages, lane));
  Where at;
  if constexpr (Kind::turn != 0)
    at = meet_by_circle<Kind>(f, met);
  else
    at = meet_by_line<Kind>(f, met);
  where(!at.decided, at.kappa) = Real(__builtin_nan(""));
  store(at.kappa, (Kind::turn != 0 ? stages.kappa : stages.duration) + lane);
}

/// The time that a Larmor circle takes.
INLINE void time(const LanePack& pack, Stages& stages, int lane) {
  const Real kappa = load(stages.kappa + lane);
  store(angle(kappa, Real(0.5) * abs(load(pack.omega + lane))) * load(pack.inverse_half + lane), stages.duration + lane);
}
