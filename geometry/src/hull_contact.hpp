// Are pieces apart? Decided by convex hulls of control points, which are halved until a line
// separates them: for Bézier curves, and all other pieces beside them.
#pragma once

#include <optional>

#include "exact_piece.hpp"

namespace carom::geometry {

/// Which ends of two pieces are one point: the end of the first and the start of the second, the
/// start of the first and the end of the second.
struct SharedEnds {
  bool forth = false, back = false;
};

/// A place, rounded, where the pieces meet elsewhere than at shared ends, fold back at one, or come
/// nearer to that than halving tells; nothing where they are apart.
std::optional<Vector> meeting(const ExactPiece& first, const ExactPiece& second, SharedEnds shared);
/// The same of a piece with itself; `closed`: its end is its start.
std::optional<Vector> meeting_with_itself(const ExactPiece& piece, bool closed);

}  // namespace carom::geometry
