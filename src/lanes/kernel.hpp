// The kernels of one instruction set: included once by each kernel_*.cpp, which names the namespace.
//
// No container and no algorithm of the standard library, and nothing outside the unnamed namespace but
// templates over the lanes' own type: a weak symbol made of wide instructions could be linked into the
// rest of the program.
#pragma once

#include <experimental/simd>
#if defined(__AVX2__)
#include <immintrin.h>
#endif

#include "carom/geometry/formulas.hpp"
#include "lanes/kernels.hpp"
#include "lanes/lane_pack.hpp"

#define INLINE [[gnu::always_inline]] inline

namespace carom::lanes {
namespace {

namespace simd = std::experimental;
using Real = simd::native_simd<double>;
using Mask = Real::mask_type;
using Vector = geometry::BasicVector<Real>;
using simd::all_of;
using simd::any_of;
using simd::where;
constexpr int width = static_cast<int>(Real::size());

// A sign is certain if the number is beyond this share of its largest size, an order of two times beyond
// that of theirs: far more than what rounding does (docs/developer/lanes.md), yet met once in 10^6 hits.
constexpr double sign_margin = 0x1p-36;
constexpr double order_margin = 0x1p-22;

INLINE Real choose(const Mask& condition, const Real& yes, const Real& no) {
  Real result = no;
  where(condition, result) = yes;
  return result;
}

INLINE Real load(const double* from) { return Real(from, simd::element_aligned); }

/// How many numbers a look-up may choose from.
enum class Reach { few, all };

/// table[index], lane by lane; index >= 0.
template <Reach reach>
INLINE Real look_up(const double* table, const Real& index, int /*size*/) {
#if defined(__AVX512F__)
  const Real bits = index + 0x1p52;  // the lowest bits are the index
  const __m512i i = _mm512_castpd_si512(static_cast<__m512d>(bits));
  if constexpr (reach == Reach::few)
    return Real(_mm512_permutex2var_pd(_mm512_loadu_pd(table), i, _mm512_loadu_pd(table + 8)));
  else
    return Real(_mm512_i64gather_pd(_mm512_and_si512(i, _mm512_set1_epi64(0xffff)), table, 8));
#else
  return Real([&](auto k) { return table[static_cast<int>(static_cast<double>(index[k]))]; });
#endif
}

#include "lanes/straight.hpp"

template <class Kind>
INLINE void advance_straight(const LaneTable& t, LanePack& pack, int lane) {
  constexpr Reach reach = Kind::reach;
  const auto of = [&](const double* numbers, const Real& piece) { return look_up<reach>(numbers, piece, t.pieces); };
  View f{t, {load(pack.x + lane), load(pack.y + lane)}, {load(pack.vx + lane), load(pack.vy + lane)},
         load(pack.piece + lane), Real(0.0), load(pack.speed + lane), load(pack.square_speed + lane)};
  const Mask active = load(pack.active + lane) > 0.0;
  f.start_wall = f.start_piece;
  if (t.divided) where(f.start_piece >= 0.0, f.start_wall) = of(t.wall, max(f.start_piece, Real(0.0)));

  const Choice choice = Kind::convex ? exit_of_loop(f) : first_of_all(f);
  const Real piece = max(choice.piece, Real(0.0));
  Mask decided = choice.decided;
  Mask gone(false);
  if constexpr (!Kind::convex) {
    const Mask none = choice.piece < 0.0;
    if (t.open) gone = decided && none;
    decided = decided && !none;
  }

  // How long the flight takes: a fraction for either kind of wall.
  const Vector point{of(t.point_x, piece), of(t.point_y, piece)};
  const Real first = of(t.first_number, piece), second = of(t.second_number, piece);
  const Vector e = f.origin - point, v = f.velocity;
  Real orientation(0.0), off_power(1.0), time, unit;
  Mask bent(Kind::circles);
  if constexpr (Kind::circles) {
    orientation = of(t.orientation, piece);
    off_power = of(t.off_power, piece);
    const Real wall = t.divided ? of(t.wall, piece) : piece;
    const Mask stands = wall == f.start_wall;
    Real a = dot(e, e) - second;
    const Real b = dot(e, v);
    const Real discriminant = b * b - a * f.square_speed;
    Real root = sqrt(max(discriminant, Real(0.0)));
    where(stands, a) = Real(0.0);
    where(stands, root) = abs(b);
    const Real n = abs(b) + root;
    const Mask away = -orientation * b <= 0.0;
    time = choose(away, -orientation * a, n);
    unit = choose(away, n, orientation * f.square_speed);
    Mask certain = stands || discriminant > (sign_margin * t.size * t.size) * f.square_speed;
    if constexpr (Kind::segments) {
      bent = orientation != 0.0;
      certain = certain || !bent;
    }
    decided = decided && certain;
  }
  if constexpr (Kind::segments) {
    const Vector tangent{first, second};
    const Real across = cross(tangent, e), along = -cross(tangent, v);
    time = Kind::circles ? choose(bent, time, across) : across;
    unit = Kind::circles ? choose(bent, unit, along) : along;
  }
  const Real duration = time / unit;
  decided = decided && duration > 0.0 && duration < __builtin_huge_val();

  // Time::operator+.
  const Real high0 = load(pack.high + lane), low0 = load(pack.low + lane);
  const Real sum = high0 + duration, part = sum - high0;
  const Real error = (high0 - (sum - part)) + (duration - part);
  const Real low1 = low0 + error, high = sum + low1, low = low1 - (high - sum);
  const Mask over = high > pack.end || (high == pack.end && low > 0.0);

  // PreparedCurve::arrive.
  const Vector x = f.origin + duration * v;
  Vector place, normal;
  Real square(1.0);
  if constexpr (Kind::circles) {
    const Vector d = x - point;
    const Real step = (0.75 - dot(first * d, d)) * (2.0 / 3.0);
    place = point + Vector{d.x + step * d.x, d.y + step * d.y};
    normal = -orientation * d;
    square = dot(off_power * d, d);
    if (t.closed_circles) decided = decided && (!bent || abs(d.y) > sign_margin * t.size);
  }
  if constexpr (Kind::segments) {
    const Vector tangent{first, second};
    const Real s = dot(x - point, tangent);
    const Vector on = point + s * tangent, across = geometry::left(tangent);
    if constexpr (Kind::circles) {
      place = {choose(bent, place.x, on.x), choose(bent, place.y, on.y)};
      normal = {choose(bent, normal.x, across.x), choose(bent, normal.y, across.y)};
      where(!bent, square) = Real(1.0);
    } else {
      place = on;
      normal = across;
    }
  }

  // Reflection.
  const Real factor = Kind::circles ? geometry::reflection_factor(v, normal, square, off_power) : 2.0 * dot(v, normal);
  const Real weight = load(pack.energy_weight + lane);
  const Real step = (0.75 - (weight * v.x * v.x + weight * v.y * v.y)) * (2.0 / 3.0);
  const Vector after = geometry::reflected(v, normal, factor, step);
  Mask escaped(false);
  if (t.divided) escaped = of(t.hole, piece) >= 0.0;
  const Mask inward = dot(normal, after) > (sign_margin * t.size) * f.speed;
  decided = decided && (escaped || over || inward);

  const Mask applies = active && decided && !over && !escaped;
  const Real hits0 = load(pack.hits + lane), hits = hits0 + 1.0;
  const Mask capped = hits >= pack.limit;
  // A whole store: one through a mask takes 30 ns without AVX.
  const auto store = [&](double* to, const Real& before, const Real& now) {
    choose(applies, now, before).copy_to(to + lane, simd::element_aligned);
  };
  store(pack.x, f.origin.x, place.x);
  store(pack.y, f.origin.y, place.y);
  store(pack.vx, v.x, after.x);
  store(pack.vy, v.y, after.y);
  store(pack.high, high0, high);
  store(pack.low, low0, low);
  store(pack.piece, f.start_piece, piece);
  store(pack.hits, hits0, hits);

  const Mask calls = active && (!decided || over || escaped || capped);
  if (any_of(calls)) [[unlikely]] {
    for (int k = 0; k < width; ++k) {
      const auto i = static_cast<std::size_t>(k);
      if (!calls[i]) continue;
      pack.met[pack.calls] = {piece[i], high[i], low[i]};
      pack.lane[pack.calls] = lane + k;
      pack.call[pack.calls++] = gone[i]       ? Call::unbounded
                                : !decided[i] ? Call::undecided
                                : over[i]     ? Call::over
                                : escaped[i]  ? Call::escaped
                                              : Call::capped;
    }
  }
}

template <bool is_convex, bool has_segments, bool has_circles, Reach how_far>
struct Straight {
  static constexpr bool convex = is_convex, segments = has_segments, circles = has_circles;
  static constexpr Reach reach = how_far;
};

template <class Kind>
void straight(const LaneTable& table, LanePack& pack) {
  pack.calls = 0;
  for (int lane = 0; lane < LanePack::lanes; lane += width) advance_straight<Kind>(table, pack, lane);
}

template <bool convex, Reach reach>
Advance straight_kernel(const LaneTable& t) {
  if (!t.circles) return straight<Straight<convex, true, false, reach>>;
  if (!t.segments) return straight<Straight<convex, false, true, reach>>;
  return straight<Straight<convex, true, true, reach>>;
}

/// The kernel of a table.
Advance kernel_of(const LaneTable& t) {
  const bool few = t.pieces <= LaneTable::fewest;
  if (t.convex) return few ? straight_kernel<true, Reach::few>(t) : straight_kernel<true, Reach::all>(t);
  return few ? straight_kernel<false, Reach::few>(t) : straight_kernel<false, Reach::all>(t);
}

}  // namespace
}  // namespace carom::lanes

#undef INLINE
