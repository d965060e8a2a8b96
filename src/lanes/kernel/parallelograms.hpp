// Straight flights among the discs of a lattice with four edges to the cell, one disc in each.
//
// The cell is a parallelogram of two lattice vectors a and b, a x b > 0. A flight leaves it
// across one edge of each pair, and the corner between those two tells by which. From cell to
// cell the sides of that corner and of the disc's centre change by v x a or v x b, one of which
// is positive and the other negative once both point forward. docs/developer/lanes.md.
#pragma once

#include "lanes/kernel/cells.hpp"

namespace carom::lanes {
namespace {

/// Flights that cross cells, one array a quantity.
struct ParallelogramCrossings {
  alignas(LanePack::alignment) double a[LanePack::lanes], b[LanePack::lanes];  ///< v x a, v x b
  double aside[LanePack::lanes], side[LanePack::lanes];  ///< of the disc's centre and of the corner
  double radius[LanePack::lanes], margin[LanePack::lanes];
  double crossed[LanePack::lanes],
      fallen[LanePack::lanes];  ///< edges, and those of them by which sides fall
  LaneMasks starts, meets, under_way;
};

/// How much sides change by an edge towards a or -a, and by one towards b or -b.
struct Forward {
  Real one, other;
};
CAROM_INLINE Forward forward(const Real& a, const Real& b) {
  return {turned_by(a, b), turned_by(b, -a)};
}

CAROM_INLINE void begin_parallelograms(const View& f, const CellOf& cell,
                                       ParallelogramCrossings& crossings, int lane) {
  const LaneTable& t = f.table;
  const Line line(f);
  const Vector v = f.velocity;
  const auto across = [&](double x, double y) { return fused(v.x, Real(y), -v.y * x); };
  const Real a = across(t.beyond_x[0], t.beyond_y[0]), b = across(t.beyond_x[1], t.beyond_y[1]);
  const Forward by = forward(a, b);
  const Real home_first = across(t.lattice_x[0], t.lattice_y[0]),
             home_second = across(t.lattice_x[1], t.lattice_y[1]);
  const Real aside = fused(cell.first, home_first,
                           fused(cell.second, home_second, line.side(t.point_x[0], t.point_y[0])));
  store(a, crossings.a + lane);
  store(b, crossings.b + lane);
  store(aside, crossings.aside + lane);
  store(fused(Real(0.5), by.one + by.other, aside + across(t.off_centre_x, t.off_centre_y)),
        crossings.side + lane);
  // A disc is cut, or not, beyond a margin in which its discriminant is as certain as the cells
  // behind ask for.
  const Real cells = cells_from_home(cell) + static_cast<double>(t.steps);
  store(Real(t.radius[0]) * f.speed, crossings.radius + lane);
  store(error_growth(cells) * (t.sizes_of_radius * f.sides), crossings.margin + lane);
  Mask starts = least_size(a, b) > f.sides && cells <= Real(LaneTable::farthest_cell), meets(false);
  // The disc of this cell was asked for, but by those that begin off it.
  const Mask off = f.start_wall < 0.0;
  if (any_of(off)) [[unlikely]] {
    const Real known = meets_disc(f, aside, line.ahead(t.point_x[0], t.point_y[0]), f.roots);
    const Mask begins = off && cell.first == 0.0 && cell.second == 0.0;
    meets = begins && starts && known > 0.0;
    starts = starts && (!begins || known < 0.0);
  }
  store(starts, crossings.starts, lane);
  store(meets, crossings.meets, lane);
}

/// A register of them.
class CrossingLanes {
 public:
  CAROM_INLINE CrossingLanes(ParallelogramCrossings& crossings, int lane)
      : crossings_(crossings),
        lane_(lane),
        by_(forward(load(crossings.a + lane), load(crossings.b + lane))),
        falls_(min(by_.one, by_.other)),
        rises_(max(by_.one, by_.other)),
        aside_(load(crossings.aside + lane)),
        side_(load(crossings.side + lane)),
        near_(load(crossings.radius + lane) + load(crossings.margin + lane)),
        crossed_(0.0),
        fallen_(0.0),
        under_way_(load(crossings.starts, lane)) {}
  /// Over an edge. A disc in a cell that was entered lies ahead, if the line cuts it.
  CAROM_INLINE void go() {
    const Mask left = side_ > 0.0;
    const Real by = choose(left, falls_, rises_);
    where(under_way_, crossed_) = crossed_ + 1.0;
    where(under_way_ && left, fallen_) = fallen_ + 1.0;
    where(under_way_, aside_) = aside_ + by;
    side_ = side_ + by;
    under_way_ = under_way_ && abs(aside_) >= near_;
  }
  CAROM_INLINE void keep() {
    store(aside_, crossings_.aside + lane_);
    store(crossed_, crossings_.crossed + lane_);
    store(fallen_, crossings_.fallen + lane_);
    store(under_way_, crossings_.under_way, lane_);
  }

 private:
  ParallelogramCrossings& crossings_;
  int lane_;
  Forward by_;
  Real falls_, rises_, aside_, side_, near_, crossed_, fallen_;
  Mask under_way_;
};

/// Over some edges, several registers side by side: each waits for itself at every edge.
template <class... Registers>
CAROM_INLINE void go(int steps, Registers&&... registers) {
  for (int step = 0; step < steps; ++step) (registers.go(), ...);
  (registers.keep(), ...);
}
CAROM_INLINE int registers_of(int lanes) {
  return lanes <= width ? 1 : lanes <= 2 * width ? 2 : together;
}
CAROM_INLINE void cross_parallelograms(const LaneTable& t, ParallelogramCrossings& crossings,
                                       int lane, int registers) {
  if (registers == 1)
    go(t.steps, CrossingLanes(crossings, lane));
  else if (registers == 2)
    go(t.steps, CrossingLanes(crossings, lane), CrossingLanes(crossings, lane + width));
  else
    go(t.steps, CrossingLanes(crossings, lane), CrossingLanes(crossings, lane + width),
       CrossingLanes(crossings, lane + 2 * width), CrossingLanes(crossings, lane + 3 * width));
}

CAROM_INLINE Crossed end_parallelograms(const LaneTable& t, const ParallelogramCrossings& crossings,
                                        CellOf& cell, int lane) {
  const Real a = load(crossings.a + lane), b = load(crossings.b + lane);
  const Forward by = forward(a, b);
  const Real fallen = load(crossings.fallen + lane),
             risen = load(crossings.crossed + lane) - fallen;
  const Mask is_one = by.one < by.other;
  const Real ones = turned_by(choose(is_one, fallen, risen), b),
             others = turned_by(choose(is_one, risen, fallen), -a);
  cell.first =
      fused(ones, Real(t.beyond_first[0]), fused(others, Real(t.beyond_first[1]), cell.first));
  cell.second =
      fused(ones, Real(t.beyond_second[0]), fused(others, Real(t.beyond_second[1]), cell.second));
  const Mask under_way = load(crossings.under_way, lane);
  const Mask cuts = abs(load(crossings.aside + lane)) <
                    load(crossings.radius + lane) - load(crossings.margin + lane);
  return {load(crossings.meets, lane) || (load(crossings.starts, lane) && !under_way && cuts),
          under_way};
}

}  // namespace
}  // namespace carom::lanes
