// The first stages of a hit of every lane: which wall, and the flight to it. Each stage passes
// over all lanes before the next one begins, so that roots and divisions of several registers
// are under way together: a core looks ahead by some hundred instructions, and a whole hit is
// longer than that.
#pragma once

#include "lanes/kernel/larmor.hpp"
#include "lanes/kernel/parallelograms.hpp"

namespace carom::lanes {
namespace {

/// What one stage leaves to the next one.
struct Stages {
  alignas(LanePack::alignment) double piece[LanePack::lanes];
  double kappa[LanePack::lanes];                        ///< of Larmor circles
  double duration[LanePack::lanes];                     ///< not a number: undecided
  double time[LanePack::lanes], unit[LanePack::lanes];  ///< a duration as a fraction
  double cell_first[LanePack::lanes], cell_second[LanePack::lanes];
  double start_x[LanePack::lanes],
      start_y[LanePack::lanes];  ///< of the flight, seen from that cell
  double high[LanePack::lanes],
      low[LanePack::lanes];                    ///< time there, of those that wait for an answer
  alignas(64) unsigned cell[LanePack::lanes];  ///< of flights that are looked up (next_disc.hpp):
                                               ///< bytes, as in LaneTable::next_discs
  LaneMasks decided, gone, bent;               ///< gone: certainly no wall follows (in this cell)
};

/// The flights from their last hits.
template <Kind kind>
CAROM_INLINE View view_of(const LaneTable& t, const LanePack& pack, int lane) {
  View f{t,
         {load(pack.x + lane), load(pack.y + lane)},
         {load(pack.vx + lane), load(pack.vy + lane)},
         load(pack.piece + lane),
         Real(0.0),
         load(pack.speed + lane),
         load(pack.square_speed + lane),
         load(pack.sides + lane),
         load(pack.roots + lane),
         load(pack.order + lane),
         Real(0.0),
         Real(0.0),
         Real(0.0),
         Real(0.0)};
  if constexpr (kind.larmor) {
    f.omega = load(pack.omega + lane);
    f.inverse_half = load(pack.inverse_half + lane);
    f.pace = load(pack.pace + lane);
    f.joint_margin = load(pack.joint_margin + lane);
  }
  f.start_wall = f.start_piece;
  if (t.divided)
    where(f.start_piece >= 0.0, f.start_wall) =
        look_up<kind.reach>(wall_numbers<kind>(t), max(f.start_piece, Real(0.0)));
  return f;
}

template <Kind kind>
CAROM_INLINE void choose_piece(const LaneTable& t, LanePack& pack, Stages& stages, int lane) {
  View f = view_of<kind>(t, pack, lane);
  Choice choice;
  Mask decided, gone(false);
  if constexpr (kind.cells && kind.larmor) {
    // Among the pieces of all cells that the circle may come to.
    choice = first_of_all_by_circle<kind>(f);
    const Real copy = max(choice.piece, Real(0.0));
    store(look_up<kind.reach>(t.copy_of, copy), stages.piece + lane);
    store(look_up<kind.reach>(t.copy_first, copy), stages.cell_first + lane);
    store(look_up<kind.reach>(t.copy_second, copy), stages.cell_second + lane);
    store(gone, stages.gone, lane);
    return store(choice.decided, stages.decided, lane);
  } else if constexpr (kind.cells) {
    CellOf cell{load(pack.cell_first + lane), load(pack.cell_second + lane)};
    choice = first_in_cells<kind>(f, cell);
    gone = choice.piece < 0.0;
    store(cell.first, stages.cell_first + lane);
    store(cell.second, stages.cell_second + lane);
  } else {
    if constexpr (kind.larmor)
      choice = kind.convex ? exit_of_loop_by_circle<kind>(f) : first_of_all_by_circle<kind>(f);
    else if constexpr (kind.convex)
      return store(exit_by_joints<kind>(f, stages.piece + lane), stages.decided, lane);
    else
      choice = first_of_all<kind.ellipses>(f);
    if constexpr (!kind.convex && !kind.larmor) gone = choice.piece < 0.0;
  }
  decided = choice.decided;
  if constexpr (!kind.convex && !kind.larmor) {
    decided = decided && !gone;
    gone = gone && choice.decided && Mask(kind.cells || t.open);
  }
  store(decided, stages.decided, lane);
  if constexpr (!kind.convex && !kind.larmor) store(gone, stages.gone, lane);
  if constexpr (!kind.single) store(max(choice.piece, Real(0.0)), stages.piece + lane);
  if constexpr (kind.larmor && !kind.convex) store(choice.kappa, stages.kappa + lane);
}

/// The piece that was chosen.
template <Kind kind>
CAROM_INLINE Real chosen(const Stages& stages, int lane) {
  return kind.single ? Real(0.0) : load(stages.piece + lane);
}

/// The time of a straight flight.
template <Kind kind>
CAROM_INLINE void divide(const LanePack& pack, Stages& stages, const Real& time, const Real& unit,
                         const Mask& decided, int lane) {
  const Real duration = time / unit;
  // A flight along an arc that is long enough ends as steeply as the sign of its reflection asks
  // for.
  const Real least =
      inward_is_known<kind> && !kind.next_disc ? load(pack.shortest + lane) : Real(0.0);
  store(duration, stages.duration + lane);
  store(decided && duration > least, stages.decided, lane);
}

template <Kind kind>
CAROM_INLINE void meet(const LaneTable& t, const LanePack& pack, Stages& stages, int lane) {
  View f = view_of<kind>(t, pack, lane);
  if constexpr (kind.cells) {
    look_from<kind>(f, {load(stages.cell_first + lane), load(stages.cell_second + lane)});
    store(f.origin.x, stages.start_x + lane);
    store(f.origin.y, stages.start_y + lane);
  }
  const Real piece = chosen<kind>(stages, lane);
  const Met met = met_by<kind>(f, piece);
  if constexpr (kind.larmor) {
    Where at = meet_by_circle<kind>(f, met);
    where(!at.decided, at.kappa) = Real(__builtin_nan(""));
    store(at.kappa, stages.kappa + lane);
  } else {
    const FractionOfTime at = meet_by_line<kind>(f, met);
    Mask decided = load(stages.decided, lane) && at.decided;
    if constexpr (kind.convex && !kind.single)
      if (t.by_signs) decided = decided && piece != no_piece;
    if constexpr (divides_apart<kind>) {
      store(at.time, stages.time + lane);
      store(at.unit, stages.unit + lane);
      store(decided, stages.decided, lane);
    } else {
      divide<kind>(pack, stages, at.time, at.unit, decided, lane);
    }
    if constexpr (kind.convex && kind.segments && kind.circles) store(met.bent, stages.bent, lane);
  }
}

/// The choice where the only piece is one disc in each cell.
template <Kind kind>
CAROM_INLINE void store_crossed(Stages& stages, const Crossed& crossed, const CellOf& cell,
                                int lane) {
  store(crossed.meets, stages.decided, lane);
  store(crossed.goes_on, stages.gone, lane);
  store(cell.first, stages.cell_first + lane);
  store(cell.second, stages.cell_second + lane);
}
template <Kind kind>
CAROM_INLINE void choose_parallelograms(const LaneTable& t, const LanePack& pack, Stages& stages) {
  ParallelogramCrossings crossings;
  const auto cell_of = [&](int lane) {
    return CellOf{load(pack.cell_first + lane), load(pack.cell_second + lane)};
  };
  for (int lane = 0; lane < pack.used; lane += together * width) {
    const int group = lane + registers_of(pack.used - lane) * width;
    for (int each = lane; each < group; each += width)
      begin_parallelograms(view_of<kind>(t, pack, each), cell_of(each), crossings, each);
  }
  for (int lane = 0; lane < pack.used; lane += together * width)
    cross_parallelograms(t, crossings, lane, registers_of(pack.used - lane));
  for (int lane = 0; lane < pack.used; lane += width) {
    CellOf cell = cell_of(lane);
    const Crossed crossed = end_parallelograms(t, crossings, cell, lane);
    store_crossed<kind>(stages, crossed, cell, lane);
  }
}
template <Kind kind>
CAROM_INLINE void choose_hexagons(const LaneTable& t, const LanePack& pack, Stages& stages) {
  HexagonCrossings crossings;
  for (int lane = 0; lane < pack.used; lane += width)
    begin_hexagons(view_of<kind>(t, pack, lane),
                   {load(pack.cell_first + lane), load(pack.cell_second + lane)}, crossings, lane);
  for (int lane = 0; lane < pack.used; lane += width) {
    CellOf cell{load(pack.cell_first + lane), load(pack.cell_second + lane)};
    const Crossed crossed = end_hexagons(view_of<kind>(t, pack, lane), crossings, cell, lane);
    store_crossed<kind>(stages, crossed, cell, lane);
  }
}

/// The same for straight flights, where it is a stage of its own.
template <Kind kind>
CAROM_INLINE void divide(const LanePack& pack, Stages& stages, int lane) {
  divide<kind>(pack, stages, load(stages.time + lane), load(stages.unit + lane),
               load(stages.decided, lane), lane);
}

/// The time that a Larmor circle takes.
CAROM_INLINE void time(const LanePack& pack, Stages& stages, int lane) {
  const Real kappa = load(stages.kappa + lane);
  store(angle(kappa, Real(0.5) * abs(load(pack.omega + lane))) * load(pack.inverse_half + lane),
        stages.duration + lane);
}

}  // namespace
}  // namespace carom::lanes
