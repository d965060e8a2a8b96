// The kernels of one instruction set: included once by each kernel_*.cpp, which names the
// namespace.
//
// No container and no algorithm of the standard library, and nothing outside the unnamed namespace
// but templates over the lanes' own type: a weak symbol made of wide instructions could be linked
// into the rest of the program.
#pragma once

#include <bit>
#include <experimental/simd>
#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include "base/angle.hpp"
#include "carom/base/time.hpp"
#include "carom/geometry/first_root.hpp"
#include "carom/geometry/formulas.hpp"
#include "lanes/simd/fused_lanes.hpp"
#include "lanes/free/kernels.hpp"
#include "lanes/free/lane_pack.hpp"

#define INLINE [[gnu::always_inline]] inline

namespace carom::lanes {
namespace {

namespace simd = std::experimental;
#include "lanes/simd/real.hpp"
#include "lanes/simd/words.hpp"
using Vector = geometry::BasicVector<Real>;

// A sign is certain if the number is beyond this share of its largest size: far more than what
// rounding does (docs/developer/lanes.md). Where times are compared, joints keep farther from the
// line.
constexpr double sign_margin = 0x1p-36;
constexpr double joint_margin = 0x1p-21;

/// A pack's flights from their last hits.
struct View {
  const LaneTable& table;
  Vector origin, velocity;
  Real start_piece, start_wall, speed, square_speed;
  Real sides, roots, order;  // margins, as in LanePack
  // Of Larmor circles.
  Real omega, inverse_half, pace, joint_margin;
};

/// The piece met first, or undecided; of a Larmor circle perhaps with kappa there.
struct Choice {
  Real piece;
  Mask decided;
  Real kappa{};
};

/// Where the sides of the joints tell the exit, they tell, too, that it is not met along the wall
/// (docs/developer/lanes.md).
template <class Kind>
constexpr bool inward_is_known =
    (Kind::turn == 0 && Kind::convex && !Kind::ellipses) || Kind::sights;

/// Divisions as a stage of their own: of several pieces a flight takes so many sums that a core
/// sees no two roots and divisions at once.
template <class Kind>
constexpr bool divides_apart = Kind::turn == 0 && (!Kind::single || Kind::sights);

/// A number of each lane's piece.
template <class Kind>
INLINE Real number_of(const double* numbers, const Real& piece) {
  if constexpr (Kind::single) return Real(numbers[0]);
  return look_up<Kind::reach>(numbers, piece);
}

/// Of what is it asked whether a flight stands on it? Larmor circles among ellipses ask it of the
/// curve.
template <class Kind>
INLINE const double* wall_numbers(const LaneTable& t) {
  return Kind::turn != 0 && Kind::ellipses ? t.ellipses.curve : t.wall;
}

/// Where a line meets a conic: at (-along ± root of `discriminant`) / square.
struct Cut {
  Real along, square, discriminant, inverse;  // 1/square, nearly
};

/// The duration of a flight, a fraction.
struct FractionOfTime {
  Real time, unit;
  Mask decided;
};
#include "lanes/kernel/ellipse.hpp"

/// What is needed of that piece.
struct Met {
  Vector point;
  Real first, second, orientation, strength;
  Mask bent, stands;
  MetEllipse ellipse{};
};

/// Where the flight meets it: kappa, or without field the duration.
struct Where {
  Real kappa;
  Mask decided;
};

#include "lanes/kernel/larmor_ellipse.hpp"
#include "lanes/kernel/larmor.hpp"
#include "lanes/kernel/straight.hpp"
#include "lanes/kernel/cells.hpp"
#include "lanes/kernel/parallelograms.hpp"
#include "lanes/kernel/stages.hpp"
#include "lanes/kernel/next_disc.hpp"
#include "lanes/kernel/landing.hpp"

template <int which_turn, bool is_convex, bool has_segments, bool has_circles, Reach how_far,
          bool has_cells = false, bool has_ellipses = false, bool is_alone = false,
          bool is_single = is_alone, bool has_sights = false>
struct Kind {
  static constexpr int turn = which_turn;
  static constexpr bool convex =
      is_convex;  ///< or without field a table where the sides of the joints tell
  static constexpr bool segments = has_segments, circles = has_circles, cells = has_cells;
  static constexpr bool ellipses = has_ellipses;
  static constexpr bool alone =
      is_alone;  ///< one closed curve about the domain, on which all particles stand
  static constexpr bool single = is_single;   ///< one piece
  static constexpr bool sights = has_sights;  ///< of a lattice, looked up (next_disc.hpp)
  static constexpr Reach reach = how_far;
};

template <class Kind>
void kernel(const LaneTable& __restrict table, LanePack& __restrict pack) {
  pack.calls = 0;
  Stages stages;
  if constexpr (Kind::sights) {
    choose_by_sight<Kind>(table, pack, stages);
  } else if constexpr (Kind::cells && Kind::single) {
    if (table.edges == 4)
      choose_parallelograms<Kind>(table, pack, stages);
    else
      choose_hexagons<Kind>(table, pack, stages);
  } else {
    for (int lane = 0; lane < pack.used; lane += width)
      choose_piece<Kind>(table, pack, stages, lane);
    if constexpr (Kind::turn == 0 && Kind::convex && !Kind::single)
      if (table.by_signs) look_up_exits(table, stages.piece, pack.used);
  }
  if constexpr (Kind::sights) {
    for (int lane = 0; lane < pack.used; lane += width) pass_in_sight(table, pack, stages, lane);
    for (int lane = 0; lane < pack.used; lane += width)
      look_from_sight<Kind>(table, pack, stages, lane);
    for (int lane = 0; lane < pack.used; lane += width)
      meet_in_sight<Kind>(table, pack, stages, lane);
  } else if (Kind::turn == 0 || Kind::convex || Kind::cells)
    for (int lane = 0; lane < pack.used; lane += width) meet<Kind>(table, pack, stages, lane);
  if constexpr (divides_apart<Kind>)
    for (int lane = 0; lane < pack.used; lane += width) divide<Kind>(pack, stages, lane);
  if (Kind::turn != 0)
    for (int lane = 0; lane < pack.used; lane += width) time(pack, stages, lane);
  for (int lane = 0; lane < pack.used; lane += width) land<Kind>(table, pack, stages, lane);
  pack.sweep += 1.0;
}

template <int turn, bool convex>
Advance kernel_of(const LaneTable& t) {
  if (t.pieces > LaneTable::fewest) return kernel<Kind<turn, convex, true, true, Reach::all>>;
  if (t.pieces > LaneTable::eight) return kernel<Kind<turn, convex, true, true, Reach::few>>;
  if (!t.circles) return kernel<Kind<turn, convex, true, false, Reach::eight>>;
  if constexpr (turn == 0) {
    if (convex && t.pieces == 1)
      return kernel<Kind<turn, convex, false, true, Reach::eight, false, false, convex>>;
    if (!t.segments) return kernel<Kind<turn, convex, false, true, Reach::eight>>;
  }
  return kernel<Kind<turn, convex, true, true, Reach::eight>>;
}
template <int turn>
Kernels kernels_of(const LaneTable& t) {
  if (t.edges > 0 && turn != 0) {
    const Advance among_copies = kernel<Kind<turn, false, false, true, Reach::all, true>>;
    return {among_copies, among_copies, width};
  }
  if (t.edges > 0) {
    const Advance over_cells =
        t.pieces > LaneTable::eight ? kernel<Kind<0, false, false, true, Reach::all, true>>
        : t.pieces > 1              ? kernel<Kind<0, false, false, true, Reach::eight, true>>
        : t.sights
            ? kernel<Kind<0, false, false, true, Reach::eight, true, false, false, true, true>>
            : kernel<Kind<0, false, false, true, Reach::eight, true, false, false, true>>;
    return {over_cells, over_cells, width};
  }
  const Advance anywhere = kernel_of<turn, false>(t);
  if (!(turn == 0 ? t.by_line : t.convex)) return {anywhere, anywhere, width};
  const Advance on_walls = kernel_of<turn, true>(t);
  return {on_walls, anywhere, width};
}

/// The kernels of a table without ellipses. A template, that it be made only where it is asked for.
template <class = void>
Kernels kernels_of(const LaneTable& t, Turn turn) {
  switch (turn) {
    case Turn::clockwise:
      return kernels_of<1>(t);
    case Turn::counter_clockwise:
      return kernels_of<-1>(t);
    case Turn::straight:
      break;
  }
  return kernels_of<0>(t);
}

}  // namespace
}  // namespace carom::lanes

#undef INLINE
