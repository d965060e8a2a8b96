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
  if constexpr (!kind.sights) store(now.piece, pack.piece + lane);
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
  if constexpr (kind.sights) return;
  keep(pack.piece, now.piece);
  const Real born = load(pack.born + lane);
  store(choose(applies, born, born + 1.0), pack.born + lane);
}

template <Kind kind>
CAROM_INLINE void land(const LaneTable& t, LanePack& pack, Stages& stages, int lane) {
  View f = view_of<kind>(t, pack, lane);
  if constexpr (kind.cells) f.origin = {load(stages.start_x + lane), load(stages.start_y + lane)};
  const Real piece = chosen<kind>(stages, lane), duration = load(stages.duration + lane);
  Vector point, v = f.velocity;
  if constexpr (kind.larmor) {
    const auto factors = geometry::flight_factors(load(stages.kappa + lane), f.omega, Real(0.5));
    point = f.origin + geometry::displacement(factors, f.velocity);
    v = geometry::turned(factors, f.velocity, f.omega);
  } else {
    point = geometry::moved(f.origin, duration, f.velocity);
  }
  constexpr bool bent_is_known = !kind.larmor && kind.convex && kind.segments && kind.circles;
  Mask bent_there;
  if constexpr (bent_is_known) bent_there = load(stages.bent, lane);
  const Met met = met_by<kind>(f, piece, bent_is_known ? &bent_there : nullptr);
  Mask decided = load(stages.decided, lane);
  if constexpr (kind.larmor) decided = decided && duration > 0.0;

  // As PreparedCurve::arrive, but for the normal's sign, which reflections do not see. The flight
  // of a Larmor circle must be seen to end on the wall.
  Landed now;
  now.piece = piece;
  Real step(0.0), off(0.0);
  const Vector d = point - met.point;
  Vector normal = normal_of<kind>(met, d);
  if constexpr (kind.circles) {
    // As step_of_length, and step_to_line.
    Vector weighted = normal;
    where(met.bent, weighted.x) = met.first * normal.x;
    where(met.bent, weighted.y) = met.first * normal.y;
    step = geometry::less_dot(choose(met.bent, Real(0.5), Real(0.0)), weighted, d);
    if constexpr (kind.larmor) off = choose(met.bent, step * (0.5 * t.size), step);
    now.place = geometry::moved(point, step, normal);
    if constexpr (kind.segments)
      where(!met.bent, step) = Real(0.0);  // reflects by strength alone, which is 2
    const Mask circle = kind.ellipses ? met.bent && !met.ellipse.is : met.bent;
    if (t.small_circles) decided = decided && (!circle || abs(step) < geometry::longest_step);
    if constexpr (kind.sights)
      decided = decided && abs(d.y) > t.start_margin;
    else if (t.closed_circles)
      decided = decided && (!circle || abs(d.y) > t.start_margin);
  } else if constexpr (kind.segments) {
    step = geometry::step_to_line(d, normal);
    if constexpr (kind.larmor) off = step;
    now.place = geometry::moved(point, step, normal);
  }
  if constexpr (kind.larmor && kind.ellipses)
    where(met.ellipse.is, off) = Real(0.0);  // they have a test of their own
  if constexpr (kind.larmor) decided = decided && abs(off) < 0x1p-38 * t.size;
  constexpr bool bent = kind.circles || kind.ellipses;
  Real factor;
  if constexpr (kind.circles)
    factor = geometry::reflection_factor_on_circle(v, normal, met.strength, step);
  else if constexpr (kind.segments)
    factor = 2.0 * geometry::fused_dot(v, normal);
  if constexpr (kind.ellipses) {
    const LandedOnEllipse on = land_on_ellipse<kind>(point, d, met.ellipse);
    const Real own = geometry::reflection_factor(v, on.gradient, on.square, Real(1.0));
    const Mask is = met.ellipse.is;
    if constexpr (kind.segments || kind.circles) {
      now.place = {choose(is, on.place.x, now.place.x), choose(is, on.place.y, now.place.y)};
      normal = {choose(is, on.gradient.x, normal.x), choose(is, on.gradient.y, normal.y)};
      factor = choose(is, own, factor);
      decided = decided && (on.certain || !is);
    } else {
      now.place = on.place;
      normal = on.gradient;
      factor = own;
      decided = decided && on.certain;
    }
  }
  const geometry::EnergyShell<Real> shell{load(pack.shell_weight + lane),
                                          load(pack.shell_rest + lane)};
  now.velocity = geometry::reflected(v, normal, factor, geometry::step_to_energy_shell(v, shell));
  // The reflection turns the normal component about, to rounding.
  Real outward = met.orientation * geometry::fused_dot(v, normal);
  if constexpr (kind.segments) where(bent ? !met.bent : Mask(true), outward) = t.size * outward;
  const Mask inward = inward_is_known<kind>
                          ? Mask(true)
                          : outward > (kind.ellipses ? met.ellipse.inward * f.speed : f.sides);
  const auto [high, low] = later(load(pack.high + lane), load(pack.low + lane), duration);
  now.high = high;
  now.low = low;
  const Real until = load(pack.until + lane);
  Mask applies = decided && inward && high < until, gone(false);
  Real hole(-1.0);
  if (!kind.sights && t.divided) {
    hole = look_up<kind.reach>(t.hole, piece);
    applies = applies && hole < 0.0;
  }
  if constexpr (kind.cells) {
    store_some<kind>(pack, lane, now, applies);
    gone = load(stages.gone, lane);
    if constexpr (kind.sights) {
      add_cells(only_where(applies, load(stages.cell + lane)), pack.cells + 2 * lane);
      const Real short_of = -geometry::fused_cross(now.velocity, normal),
                 aside = fused(step, short_of, short_of);
      store_where(applies, aside, pack.aside + lane);
      store_where(applies, aside, pack.aside_home + lane);
      store_where(gone, load(pack.born + lane) + 1.0, pack.born + lane);
    } else {
      const CellOf cell{load(stages.cell_first + lane), load(stages.cell_second + lane)};
      store_where(applies, load(pack.home_first + lane) + cell.first, pack.home_first + lane);
      store_where(applies, load(pack.home_second + lane) + cell.second, pack.home_second + lane);
      // Those still on their way only change their cell.
      store(choose(gone, cell.first, Real(0.0)), pack.cell_first + lane);
      store(choose(gone, cell.second, Real(0.0)), pack.cell_second + lane);
    }
  } else {
    if (!any_of(!applies)) [[likely]]
      return store_all<kind>(pack, lane, now);
    store_some<kind>(pack, lane, now, applies);
  }

  const Mask over = high >= until, escaped = hole >= 0.0;  // over, or there to the last digit
  if constexpr (!kind.convex && !kind.larmor && !kind.cells) gone = load(stages.gone, lane);
  unsigned waiting = bits_of(kind.cells ? !(applies || gone) : !applies);
  if (waiting == 0) return;
  waiting &= bits_of(load(pack.active + lane) > 0.0);
  if (waiting == 0) return;
  store(high, stages.high + lane);
  store(low, stages.low + lane);
  const unsigned open = bits_of(gone), ends = bits_of(over),
                 certain = bits_of(decided && (escaped || over || inward) &&
                                   duration < __builtin_huge_val());
  for (; waiting != 0; waiting &= waiting - 1) {
    const int i = __builtin_ctz(waiting), at = lane + i;
    const unsigned bit = 1u << i;
    if constexpr (kind.sights) pack.born[at] += 1.0;
    pack.met[pack.calls] = {kind.single ? 0.0 : stages.piece[at], stages.high[at], stages.low[at]};
    pack.lane[pack.calls] = at;
    pack.call[pack.calls++] = (open & bit) != 0      ? Call::unbounded
                              : (certain & bit) == 0 ? Call::undecided
                              : (ends & bit) != 0    ? Call::over
                                                     : Call::escaped;
  }
}

}  // namespace
}  // namespace carom::lanes
