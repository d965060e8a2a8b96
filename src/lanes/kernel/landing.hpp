// The last stage of a hit of every lane: put back on its wall, reflected and stored; or a call.
#pragma once

#include "carom/base/time.hpp"
#include "lanes/kernel/next_disc.hpp"

namespace carom::lanes {
namespace {

/// What a hit makes of a lane.
struct Landed {
  Vector place, velocity;
  Real high, low, piece;
};

template <Kind kind>
CAROM_INLINE void store_all(LanePack& pack, int lane, const Landed& now) {
  store(now.place.x, pack.x + lane);
  store(now.place.y, pack.y + lane);
  store(now.velocity.x, pack.vx + lane);
  store(now.velocity.y, pack.vy + lane);
  store(now.high, pack.high + lane);
  store(now.low, pack.low + lane);
  if constexpr (!kind.next_disc) store(now.piece, pack.piece + lane);
}
/// Where it applies. Whole stores: one through a mask takes 30 ns without AVX.
template <Kind kind>
CAROM_INLINE void store_some(LanePack& pack, int lane, const Landed& now, const Mask& applies) {
  const auto keep = [&](double* to, const Real& number) {
    store_where(applies, number, to + lane);
  };
  keep(pack.x, now.place.x);
  keep(pack.y, now.place.y);
  keep(pack.vx, now.velocity.x);
  keep(pack.vy, now.velocity.y);
  keep(pack.high, now.high);
  keep(pack.low, now.low);
  if constexpr (kind.next_disc) return;
  keep(pack.piece, now.piece);
  const Real born = load(pack.born + lane);
  store(choose(applies, born, born + 1.0), pack.born + lane);
}

/// Where a flight ends by its formula, which rounds; and its velocity there.
struct FlightEnd {
  Vector point, velocity;
};
template <Kind kind>
CAROM_INLINE FlightEnd end_of_flight(const View& f, const Stages& stages, const Real& duration,
                                     int lane) {
  if constexpr (!kind.larmor) return {geometry::moved(f.origin, duration, f.velocity), f.velocity};
  const auto factors = geometry::flight_factors(load(stages.kappa + lane), f.omega, Real(0.5));
  return {f.origin + geometry::displacement(factors, f.velocity),
          geometry::turned_by(f.omega * factors.along, f.omega * factors.across, f.velocity)};
}

/// That end put back on the wall, as PreparedCurve::arrive does except for the normal's sign, which
/// reflections do not see.
struct OnWall {
  Vector place, normal;
  Real factor;   ///< of the reflection along the normal
  Real step;     ///< from the end to the place, in normals; 0 on a segment
  Mask certain;  ///< not near the start of a closed curve; of Larmor flights: it was on the wall
};
constexpr double on_the_wall = 0x1p-38;  ///< in sizes of the table

template <Kind kind>
CAROM_INLINE OnWall on_segment(const LaneTable& t, const FlightEnd& end, const Met& met) {
  const Vector normal{met.first, met.second};
  const Real step = geometry::step_to_line(end.point - met.point, normal);
  const Mask certain = kind.larmor ? abs(step) < on_the_wall * t.size : Mask(true);
  return {geometry::moved(end.point, step, normal), normal,
          2.0 * geometry::fused_dot(end.velocity, normal), Real(0.0), certain};
}

/// A circle or, where the table has segments, too, one of these: both by one formula
/// (geometry::step_of_length and step_to_line).
template <Kind kind>
CAROM_INLINE OnWall on_circle(const LaneTable& t, const FlightEnd& end, const Met& met) {
  const Vector d = end.point - met.point, normal = normal_of<kind>(met, d);
  Vector weighted = normal;
  where(met.bent, weighted.x) = met.first * normal.x;
  where(met.bent, weighted.y) = met.first * normal.y;
  Real step = geometry::less_dot(choose(met.bent, Real(0.5), Real(0.0)), weighted, d);
  const Vector place = geometry::moved(end.point, step, normal);
  Mask certain(true);
  if constexpr (kind.larmor)
    certain = abs(choose(met.bent, step * (0.5 * t.size), step)) < on_the_wall * t.size;
  // A segment reflects by its strength alone, which is 2.
  if constexpr (kind.segments) where(!met.bent, step) = Real(0.0);
  if (t.small_circles) certain = certain && (!met.bent || abs(step) < geometry::longest_step);
  if constexpr (kind.next_disc)
    certain = certain && abs(d.y) > t.start_margin;
  else if (t.closed_circles)
    certain = certain && (!met.bent || abs(d.y) > t.start_margin);
  return {place, normal,
          geometry::reflection_factor_on_circle(end.velocity, normal, met.strength, step), step,
          certain};
}

template <Kind kind>
CAROM_INLINE OnWall on_ellipse(const FlightEnd& end, const Met& met) {
  const LandedOnEllipse on = land_on_ellipse<kind>(end.point, end.point - met.point, met.ellipse);
  return {on.place, on.gradient,
          geometry::reflection_factor(end.velocity, on.gradient, on.square, Real(1.0)), Real(0.0),
          on.certain};
}

/// The wall of any piece that the kernel's tables may have.
template <Kind kind>
CAROM_INLINE OnWall on_wall(const LaneTable& t, const FlightEnd& end, const Met& met) {
  if constexpr (!kind.ellipses && !kind.circles) return on_segment<kind>(t, end, met);
  if constexpr (!kind.ellipses && kind.circles) return on_circle<kind>(t, end, met);
  const OnWall ellipse = on_ellipse<kind>(end, met);
  if constexpr (!kind.segments && !kind.circles) return ellipse;
  const OnWall other = on_circle<kind>(t, end, met);
  const Mask is = met.ellipse.is;
  const auto either = [&](const Real& a, const Real& b) { return choose(is, a, b); };
  return {{either(ellipse.place.x, other.place.x), either(ellipse.place.y, other.place.y)},
          {either(ellipse.normal.x, other.normal.x), either(ellipse.normal.y, other.normal.y)},
          either(ellipse.factor, other.factor),
          other.step,
          (is && ellipse.certain) || (!is && other.certain)};
}

/// Does a reflected velocity certainly point into the domain? The reflection turns the normal
/// component about, to rounding.
template <Kind kind>
CAROM_INLINE Mask is_inward(const View& f, const Met& met, const Vector& before,
                            const Vector& normal) {
  if constexpr (inward_is_known<kind>) return Mask(true);
  Real outward = met.orientation * geometry::fused_dot(before, normal);
  if constexpr (kind.segments)
    where(kind.circles || kind.ellipses ? !met.bent : Mask(true), outward) = f.table.size * outward;
  if constexpr (kind.ellipses) return outward > met.ellipse.inward * f.speed;
  return outward > f.sides;
}

/// Stores a hit on a lattice where it applies; flights that are `gone` on go on from their cell.
template <Kind kind>
CAROM_INLINE void store_on_lattice(LanePack& pack, const Stages& stages, int lane,
                                   const Landed& now, const OnWall& on, const Mask& applies,
                                   const Mask& gone) {
  store_some<kind>(pack, lane, now, applies);
  if constexpr (kind.next_disc) {
    add_cells(only_where(applies, load(stages.cell + lane)), pack.cells + 2 * lane);
    const Real short_of = -geometry::fused_cross(now.velocity, on.normal),
               aside = fused(on.step, short_of, short_of);
    store_where(applies, aside, pack.aside + lane);
    store_where(applies, aside, pack.aside_home + lane);
    store_where(gone, load(pack.born + lane) + 1.0, pack.born + lane);
  } else {
    const CellOf cell{load(stages.cell_first + lane), load(stages.cell_second + lane)};
    store_where(applies, load(pack.home_first + lane) + cell.first, pack.home_first + lane);
    store_where(applies, load(pack.home_second + lane) + cell.second, pack.home_second + lane);
    store(choose(gone, cell.first, Real(0.0)), pack.cell_first + lane);
    store(choose(gone, cell.second, Real(0.0)), pack.cell_second + lane);
  }
}

/// Calls for the lanes of a register that wait, by bits.
struct Waiting {
  unsigned lanes, gone, certain, over;
};
template <Kind kind>
CAROM_INLINE void add_calls(LanePack& pack, const Stages& stages, int lane, Waiting waiting) {
  for (; waiting.lanes != 0; waiting.lanes &= waiting.lanes - 1) {
    const int i = __builtin_ctz(waiting.lanes), at = lane + i;
    const unsigned bit = 1u << i;
    if constexpr (kind.next_disc) pack.born[at] += 1.0;
    pack.met[pack.calls] = {kind.single ? 0.0 : stages.piece[at], stages.high[at], stages.low[at]};
    pack.lane[pack.calls] = at;
    pack.call[pack.calls++] = (waiting.gone & bit) != 0      ? Call::unbounded
                              : (waiting.certain & bit) == 0 ? Call::undecided
                              : (waiting.over & bit) != 0    ? Call::over
                                                             : Call::escaped;
  }
}

template <Kind kind>
CAROM_INLINE void land(const LaneTable& t, LanePack& pack, Stages& stages, int lane) {
  View f = view_of<kind>(t, pack, lane);
  if constexpr (kind.cells) f.origin = {load(stages.start_x + lane), load(stages.start_y + lane)};
  const Real piece = chosen<kind>(stages, lane), duration = load(stages.duration + lane);
  constexpr bool bent_is_known = !kind.larmor && kind.convex && kind.segments && kind.circles;
  Mask bent_there;
  if constexpr (bent_is_known) bent_there = load(stages.bent, lane);
  const Met met = met_by<kind>(f, piece, bent_is_known ? &bent_there : nullptr);
  const FlightEnd end = end_of_flight<kind>(f, stages, duration, lane);
  const OnWall on = on_wall<kind>(t, end, met);
  Mask decided = load(stages.decided, lane) && on.certain;
  if constexpr (kind.larmor) decided = decided && duration > 0.0;

  const geometry::EnergyShell<Real> shell{load(pack.shell_weight + lane),
                                          load(pack.shell_rest + lane)};
  const auto [high, low] = later(load(pack.high + lane), load(pack.low + lane), duration);
  const Landed now{on.place,
                   geometry::reflected(end.velocity, on.normal, on.factor,
                                       geometry::step_to_energy_shell(end.velocity, shell)),
                   high, low, piece};
  const Mask inward = is_inward<kind>(f, met, end.velocity, on.normal);
  const Mask over = high >= load(pack.until + lane);  // or there to the last digit
  Mask applies = decided && inward && !over, gone(false), escaped(false);
  if (!kind.next_disc && t.divided) {
    escaped = look_up<kind.reach>(t.hole, piece) >= 0.0;
    applies = applies && !escaped;
  }
  if constexpr (kind.cells) {
    gone = load(stages.gone, lane);
    store_on_lattice<kind>(pack, stages, lane, now, on, applies, gone);
  } else {
    if (!any_of(!applies)) [[likely]]
      return store_all<kind>(pack, lane, now);
    store_some<kind>(pack, lane, now, applies);
    if constexpr (!kind.convex && !kind.larmor) gone = load(stages.gone, lane);
  }

  unsigned waiting = bits_of(kind.cells ? !(applies || gone) : !applies);
  if (waiting == 0) return;
  waiting &= bits_of(load(pack.active + lane) > 0.0);
  if (waiting == 0) return;
  store(high, stages.high + lane);
  store(low, stages.low + lane);
  const Mask certain = decided && (escaped || over || inward) && duration < __builtin_huge_val();
  add_calls<kind>(pack, stages, lane, {waiting, bits_of(gone), bits_of(certain), bits_of(over)});
}

}  // namespace
}  // namespace carom::lanes
