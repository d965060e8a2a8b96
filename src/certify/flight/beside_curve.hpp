// Flights among pieces of curves: where they go, and proofs that they meet nothing before.
#pragma once

#include <optional>

#include "certify/flight/flight.hpp"
#include "certify/wall/piece.hpp"

namespace carom::certify {

/// A straight flight, or an arc of a circle.
struct FlightBetween {
  BallVector from;
  std::optional<BallVector> to;  ///< none: a ray, or the whole circle
  BallVector direction;          ///< where it begins, of any length
  Ball curvature;                ///< times that length; positive: it turns clockwise
};
/// Of a point e from where a flight begins: zero on its line or circle, and it rises where a
/// flight leaves to the left of a curve. (2 d x e + k e.e, as geometry::side_of_flight.)
inline Ball side_of_flight(const BallVector& direction, const Ball& curvature,
                           const BallVector& e) {
  return Ball(2) * cross(direction, e) + curvature * dot(e, e);
}
/// How fast that changes where the point moves.
inline Ball slope_of_side(const BallVector& direction, const Ball& curvature, const BallVector& e,
                          const BallVector& moves) {
  return Ball(2) * (cross(direction, moves) + curvature * dot(e, moves));
}

/// About where a flight first leaves the domain, if it does: a guess, to begin a proof with.
std::optional<Pieces::Spot> first_exit(const Pieces&, const FlightBetween&);
/// Proves it: false where it is not so, or cannot be decided. `first` and `last` enclose the
/// parameters at both ends; no first one: the flight begins off the curves.
bool meets_nowhere_else(const Pieces&, const FlightBetween&,
                        const std::optional<Pieces::Spot>& first,
                        const std::optional<Pieces::Spot>& last);
/// How often the curves go round a point, counter-clockwise where the domain is on their left.
/// Nothing where that cannot be decided: near a curve.
std::optional<int> turns_round(const Pieces&, const BallVector& point);

}  // namespace carom::certify
