// What a kernel knows of the flights in a register, and what its stages say of them.
#pragma once

#include "carom/geometry/formulas.hpp"
#include "lanes/free/lane_pack.hpp"
#include "lanes/simd/real.hpp"

namespace carom::lanes {
namespace {

using Vector = geometry::BasicVector<Real>;
using LaneMasks = Masks<LanePack::lanes>;

// A sign is certain if the number is beyond this share of its largest size: rounding does 2^-44 of
// it at most, by the table in docs/developer/lanes.md#margins. Where times are compared, joints
// keep farther from the line: the same table, "order of two times".
constexpr double sign_margin = 0x1p-36;
constexpr double joint_margin = 0x1p-21;

/// What the flights and the table of a kernel have in common: all that it knows when it is
/// compiled.
struct Kind {
  bool larmor =
      false;  ///< circles that all turn the way of LaneTable::clockwise; else straight flights
  bool convex = false;  ///< or without field a table where the sides of the joints tell
  bool segments = false, circles = false, ellipses = false;  ///< the table may have such pieces
  bool cells = false;                                        ///< on a lattice
  bool alone = false;      ///< one closed curve about the domain, on which all particles stand
  bool single = false;     ///< one piece
  bool next_disc = false;  ///< looked up in a table (next_disc.hpp)
  Reach reach = reach_here(Reach::eight);  ///< of look-ups by piece
};
constexpr Kind reading(Kind kind, Reach reach) {
  kind.reach = reach_here(reach);
  return kind;
}

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
template <Kind kind>
constexpr bool inward_is_known = (!kind.larmor && kind.convex && !kind.ellipses) || kind.next_disc;

/// Divisions as a stage of their own: of several pieces a flight takes so many sums that a core
/// sees no two roots and divisions at once.
template <Kind kind>
constexpr bool divides_apart = !kind.larmor && (!kind.single || kind.next_disc);

/// A number of each lane's piece.
template <Kind kind>
CAROM_INLINE Real number_of(const double* numbers, const Real& piece) {
  if constexpr (kind.single) return Real(numbers[0]);
  return look_up<kind.reach>(numbers, piece);
}

/// For which curves is it asked whether a flight starts on them? Larmor circles among ellipses ask
/// it of the curve.
template <Kind kind>
CAROM_INLINE const double* wall_numbers(const LaneTable& t) {
  return kind.larmor && kind.ellipses ? t.ellipses.curve : t.wall;
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

}  // namespace
}  // namespace carom::lanes
