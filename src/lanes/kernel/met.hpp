// What a landing needs of the piece that was chosen, lane by lane.
#pragma once

#include "lanes/kernel/ellipse.hpp"

namespace carom::lanes {
namespace {

/// What is needed of that piece.
struct Met {
  Vector point;
  Real first, second, orientation, strength;
  Mask bent, on_wall;
  MetEllipse ellipse{};
};

/// What is needed of it.
template <Kind kind>
CAROM_INLINE Met met_by(const View& f, const Real& piece, const Mask* bent = nullptr) {
  const LaneTable& t = f.table;
  const auto of = [&](const double* numbers) { return number_of<kind>(numbers, piece); };
  Met met{{of(t.point_x), of(t.point_y)},
          of(t.first_number),
          of(t.second_number),
          Real(1.0),
          Real(2.0),
          Mask(kind.circles || kind.ellipses),
          Mask(kind.alone)};
  if constexpr (kind.circles || kind.ellipses) {
    met.strength = of(t.strength);
    if constexpr (kind.segments) met.bent = bent ? *bent : of(t.orientation) != 0.0;
    if constexpr (!kind.convex) {
      met.orientation = of(t.orientation);
      if constexpr (kind.segments) where(!met.bent, met.orientation) = Real(1.0);
    }
  }
  if constexpr (kind.ellipses) met.ellipse = ellipse_met_by<kind>(t, piece);
  if constexpr (!kind.alone && !(kind.cells && kind.single) &&
                (kind.circles || kind.ellipses || kind.convex || kind.larmor))
    met.on_wall = (t.divided ? of(t.wall) : piece) == f.start_wall;
  return met;
}

}  // namespace
}  // namespace carom::lanes
