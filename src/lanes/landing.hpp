// The last stage of a hit of every lane: put back on its wall, reflected and stored; or a call. Included by kernel.hpp
// inside the namespace of its instruction set.

template <class Kind>
INLINE void land(const LaneTable& t, LanePack& pack, const Stages& stages, int lane) {
  constexpr bool larmor = Kind::turn != 0;
  const auto of = [&](const double* numbers, const Real& piece) { return look_up<Kind::reach>(numbers, piece); };
  const View f = view_of<Kind>(t, pack, lane);
  const Vector start = f.origin;
  const Real start_piece = f.start_piece;
  const Real piece = load(stages.piece + lane), known = load(stages.known + lane);
  Mask decided = known > 0.0, gone(false);
  if constexpr (!Kind::convex) gone = known < 0.0;
  const Met met = met_by<Kind>(f, piece);
  const Meeting at{{load(stages.x + lane), load(stages.y + lane)},
                   larmor ? Vector{load(stages.vx + lane), load(stages.vy + lane)} : f.velocity,
                   load(stages.duration + lane), decided};
  const Vector v = at.velocity;

  const Real high0 = load(pack.high + lane), low0 = load(pack.low + lane);
  const auto [high, low] = later(high0, low0, at.duration);
  const Mask over = high >= pack.end;  // or there to the last digit

  // As PreparedCurve::arrive. The flight of a Larmor circle must be seen to end on the wall.
  Vector place, normal;
  Real square(1.0), off(0.0);
  if constexpr (Kind::circles) {
    const Vector d = at.point - met.point;
    place = met.point + geometry::back_to_circle(d, met.first);
    normal = -met.orientation * d;
    square = dot(met.off_power * d, d);
    if constexpr (larmor) off = (0.75 - dot(met.first * d, d)) * (0.25 * t.size);
    if (t.closed_circles) decided = decided && (!met.bent || abs(d.y) > sign_margin * t.size);
  }
  if constexpr (Kind::segments) {
    const Vector tangent{met.first, met.second};
    const Vector on = geometry::back_to_line(at.point, met.point, tangent), across = geometry::left(tangent);
    if constexpr (larmor) off = choose(met.bent, off, cross(tangent, at.point - met.point));
    if constexpr (Kind::circles) {
      place = {choose(met.bent, place.x, on.x), choose(met.bent, place.y, on.y)};
      normal = {choose(met.bent, normal.x, across.x), choose(met.bent, normal.y, across.y)};
      where(!met.bent, square) = Real(1.0);
    } else {
      place = on;
      normal = across;
    }
  }
  if constexpr (larmor) decided = decided && abs(off) < 0x1p-38 * t.size;

  const Real factor =
      Kind::circles ? geometry::reflection_factor(v, normal, square, met.off_power) : 2.0 * dot(v, normal);
  const Vector after = geometry::reflected(v, normal, factor, geometry::step_to_energy_shell(v, load(pack.energy_weight + lane)));
  Mask escaped(false);
  if (t.divided) escaped = of(t.hole, piece) >= 0.0;
  const Mask inward = dot(normal, after) > (sign_margin * t.size) * f.speed;
  decided = decided && (escaped || over || inward);

  const Mask applies = decided && !over && !escaped;
  const Real hits0 = load(pack.hits + lane), hits = hits0 + 1.0;
  if (!any_of(!applies)) [[likely]] {
    store(place.x, pack.x + lane);
    store(place.y, pack.y + lane);
    store(after.x, pack.vx + lane);
    store(after.y, pack.vy + lane);
    store(high, pack.high + lane);
    store(low, pack.low + lane);
    store(piece, pack.piece + lane);
    store(hits, pack.hits + lane);
  } else {
    // A whole store: one through a mask takes 30 ns without AVX.
    const auto keep = [&](double* to, const Real& before, const Real& now) { store(choose(applies, now, before), to + lane); };
    keep(pack.x, start.x, place.x);
    keep(pack.y, start.y, place.y);
    keep(pack.vx, f.velocity.x, after.x);
    keep(pack.vy, f.velocity.y, after.y);
    keep(pack.high, high0, high);
    keep(pack.low, low0, low);
    keep(pack.piece, start_piece, piece);
    keep(pack.hits, hits0, hits);
  }

  if constexpr (Kind::cells) {
    const auto add = [&](double* to, const double* more) {
      const Real before = load(to + lane);
      store(choose(applies, before + load(more + lane), before), to + lane);
    };
    add(pack.home_first, stages.cell_first);
    add(pack.home_second, stages.cell_second);
  }

  const Mask capped = hits >= pack.limit;
  Mask calls = load(pack.active + lane) > 0.0 && (!applies || capped);
  if constexpr (Kind::cells) calls = calls && !gone;
  if (any_of(calls)) [[unlikely]] {
    for (int i = 0; i < width; ++i) {
      if (!lane_of(calls, i)) continue;
      pack.met[pack.calls] = {lane_of(piece, i), lane_of(high, i), lane_of(low, i)};
      pack.lane[pack.calls] = lane + i;
      pack.call[pack.calls++] = lane_of(gone, i)       ? Call::unbounded
                                : !lane_of(decided, i) ? Call::undecided
                                : lane_of(over, i)     ? Call::over
                                : lane_of(escaped, i)  ? Call::escaped
                                              : Call::capped;
    }
  }
}
