// Straight flights against ellipses in lanes.
//
// The form that is 1 on an ellipse, times the square of a length below its smaller semi-axis,
// has the sizes of a circle's e.e - r^2: so it is chosen with a circle's margins.
#pragma once

#include "carom/geometry/formulas.hpp"
#include "lanes/kernel/flight.hpp"

namespace carom::lanes {
namespace {

/// What is needed of the ellipse that was chosen.
struct MetEllipse {
  Vector axis, first, second;
  Real along, across, shrink, off, at_start, inward;
  Mask is;
};
template <Kind kind>
CAROM_INLINE MetEllipse ellipse_met_by(const LaneTable& t, const Real& piece) {
  const auto of = [&](const double* numbers) { return number_of<kind>(numbers, piece); };
  const auto& all = t.ellipses;
  MetEllipse met{{of(all.axis_x), of(all.axis_y)},
                 {of(all.first_x), of(all.first_y)},
                 {of(all.second_x), of(all.second_y)},
                 of(all.along),
                 of(all.across),
                 of(all.shrink),
                 of(all.off),
                 of(all.at_start),
                 of(all.inward),
                 Mask(true)};
  if constexpr (kind.segments || kind.circles) met.is = met.shrink > 0.0;
  return met;
}

/// The same of an ellipse, its form shrunk.
CAROM_INLINE Cut cut_of_ellipse(const View& f, int i) {
  const LaneTable& t = f.table;
  const auto& all = t.ellipses;
  const Real shrink(all.shrink[i]);
  const auto q = geometry::ellipse_quadratic(
      f.origin - Vector{Real(t.point_x[i]), Real(t.point_y[i])}, f.velocity,
      {Real(all.axis_x[i]), Real(all.axis_y[i])}, Real(all.along[i]), Real(all.across[i]));
  const Real square = shrink * q.c;
  return {shrink * q.b, square, (shrink * shrink) * fused(q.b, q.b, -(q.a * q.c)), 1.0 / square};
}

/// Time of the flight to an ellipse.
template <Kind kind>
CAROM_INLINE FractionOfTime time_to_ellipse(const View& f, const Vector& e, const MetEllipse& met,
                                            const Real& orientation, const Mask& on_wall) {
  auto q = geometry::ellipse_quadratic(e, f.velocity, met.axis, met.along, met.across);
  // On the only wall there is: no root is taken.
  if constexpr (kind.alone) return {Real(2.0) * abs(q.b), q.c, Mask(true)};
  const Real discriminant = geometry::discriminant_of(q);
  Real root = sqrt(max(discriminant, Real(0.0)));
  where(on_wall, q.a) = Real(0.0);
  where(on_wall, root) = abs(q.b);
  const Real n = abs(q.b) + root;
  const Mask away = -orientation * q.b <= 0.0;
  return {choose(away, -orientation * q.a, n), choose(away, n, orientation * q.c),
          on_wall || met.shrink * met.shrink * discriminant > f.roots};
}

/// The landing at a point, d seen from the centre.
struct LandedOnEllipse {
  Vector place, gradient;
  Real square;
  Mask certain;  ///< on the wall, and not near the start of a closed one
};
template <Kind kind>
CAROM_INLINE LandedOnEllipse land_on_ellipse(const Vector& point, const Vector& d,
                                             const MetEllipse& met) {
  const auto on = geometry::on_ellipse(d, met.first, met.second);
  const Vector place = geometry::moved(point, on.step, d);
  Mask certain = abs(on.image.y) > met.at_start;
  if constexpr (!kind.alone) certain = certain && abs(on.step) < met.off;
  return {place, on.gradient, dot(on.gradient, on.gradient), certain};
}

}  // namespace
}  // namespace carom::lanes
