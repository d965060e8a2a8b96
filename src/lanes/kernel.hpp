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

#include "base/angle.hpp"
#include "carom/base/time.hpp"
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
INLINE Real look_up(const double* table, const Real& index) {
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

/// A pack's flights from their last hits.
struct View {
  const LaneTable& table;
  Vector origin, velocity;
  Real start_piece, start_wall, speed, square_speed;
  // Of Larmor circles.
  Real omega, inverse_half, pace, joint_margin;
};

/// The piece met first, or undecided; of a Larmor circle perhaps with kappa there.
struct Choice {
  Real piece;
  Mask decided;
  Real kappa{};
};

/// What is needed of that piece.
struct Met {
  Vector point;
  Real first, second, orientation, off_power;
  Mask bent, stands;
};

/// The flight to it.
struct Meeting {
  Vector point, velocity;
  Real duration;
  Mask decided;
};

#include "lanes/larmor.hpp"
#include "lanes/straight.hpp"
#include "lanes/landing.hpp"

template <int which_turn, bool is_convex, bool has_segments, bool has_circles, Reach how_far>
struct Kind {
  static constexpr int turn = which_turn;
  static constexpr bool convex = is_convex, segments = has_segments, circles = has_circles;
  static constexpr Reach reach = how_far;
};

template <class Kind>
void kernel(const LaneTable& table, LanePack& pack) {
  pack.calls = 0;
  for (int lane = 0; lane < LanePack::lanes; lane += width) advance<Kind>(table, pack, lane);
}

template <int turn, bool convex, Reach reach>
Advance kernel_of(const LaneTable& t) {
  if (!t.circles) return kernel<Kind<turn, convex, true, false, reach>>;
  if (!t.segments) return kernel<Kind<turn, convex, false, true, reach>>;
  return kernel<Kind<turn, convex, true, true, reach>>;
}
template <int turn, bool convex>
Advance kernel_of(const LaneTable& t) {
  return t.pieces <= LaneTable::fewest ? kernel_of<turn, convex, Reach::few>(t) : kernel_of<turn, convex, Reach::all>(t);
}
template <int turn>
Kernels kernels_of(const LaneTable& t) {
  const Advance anywhere = turn == 0 && t.convex ? nullptr : kernel_of<turn, false>(t);
  if (!t.convex) return {anywhere, anywhere};
  const Advance on_walls = kernel_of<turn, true>(t);
  return {on_walls, turn == 0 ? on_walls : anywhere};
}

/// The kernels of a table.
Kernels kernels_of(const LaneTable& t, Turn turn) {
  switch (turn) {
    case Turn::clockwise: return kernels_of<1>(t);
    case Turn::counter_clockwise: return kernels_of<-1>(t);
    case Turn::straight: break;
  }
  return kernels_of<0>(t);
}

}  // namespace
}  // namespace carom::lanes

#undef INLINE
