// Where two pieces of boundary meet, decided exactly.
#pragma once

#include <vector>

#include "exact_piece.hpp"

namespace carom::geometry {

struct Contact {
  enum class Kind {
    cross,     ///< inside both pieces, from one side to the other
    touch,     ///< inside both pieces, without changing sides
    joint,     ///< at an end of at least one of them
    together,  ///< they have a piece of curve in common
  } kind;
  Where on_first, on_second;
  Vector place;  ///< rounded
};

std::vector<Contact> contacts(const ExactPiece& first, const ExactPiece& second);

/// Two full circles by their distance: how the discs lie.
enum class Discs { apart, touching, crossing, nested, touching_nested, equal };
Discs compare_discs(const ExactCurve& first, const ExactCurve& second);

/// A ray along which a boundary leaves a point: direction t and curvature bend/|t|^3.
struct BoundaryRay {
  DyadicVector t;
  Dyadic bend;
};
/// The rays of a boundary that arrives at the point on `in` and leaves on `out`.
struct BoundaryRays {
  BoundaryRay back, forth;
};
BoundaryRays rays_at(const ExactCurve& in, const ExactCurve& out, const ExactPoint& point);
/// Do two boundaries that meet at a point pass through each other there? `zero`: they touch so
/// closely (same tangent and curvature) that this is not decided.
Sign pass_through(const BoundaryRays& first, const BoundaryRays& second);

}  // namespace carom::geometry
