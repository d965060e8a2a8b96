#include "certify/flight/beside_curve.hpp"

#include <array>
#include <vector>

namespace carom::certify {
namespace {

constexpr int most_halvings = 40;

/// Of the points about the middle of a part of the curve's length.
Ball parameter_of(const CurveOfFormulas& curve, double middle, double half) {
  return curve.from() + Ball(middle).widened(Bound(half)) * curve.length();
}

/// Counts crossings of a ray from a point, by sides of it.
class Winding {
 public:
  Winding(const CurveOfFormulas& curve, const BallVector& point) : curve_(curve), point_(point) {}

  std::optional<int> find() {
    const Sign from = side_at(0.0), to = curve_.periodic() ? from : side_at(1.0);
    if (from == Sign::undecided || to != from || !count(0.0, from, 1.0, to, most_halvings))
      return {};
    return twice_ / 2;
  }

 private:
  // In a direction that no curve has for its axis.
  BallVector seen(const BallVector& x) const {
    const BallVector e = x - point_, ray{Ball(0x1.8p0), Ball(0x1.1caf2p0)};
    return {dot(ray, e), cross(ray, e)};
  }
  /// Of the ray. Behind its start any side will do.
  Sign side_at(double share) const {
    const BallVector e = seen(curve_.at(parameter_of(curve_, share, 0.0)).point);
    const Sign side = sign(e.y);
    if (side == Sign::positive || side == Sign::negative) return side;
    return sign(e.x) == Sign::negative ? Sign::positive : Sign::undecided;
  }
  bool count(double a, Sign from, double b, Sign to, int depth) {
    const double half = 0.5 * (b - a) + 0x1p-52;  // more than rounding takes from parts of [0, 1]
    const BallVector e = seen(curve_.at(parameter_of(curve_, 0.5 * (a + b), half)).point);
    const Sign side = sign(e.y);
    if (side == Sign::positive || side == Sign::negative || sign(e.x) == Sign::negative)
      return true;
    if (sign(e.x) == Sign::positive) {
      twice_ += (to == Sign::positive ? 1 : -1) - (from == Sign::positive ? 1 : -1);
      return true;
    }
    for (const double share : {0.5, 0.4375, 0.5625}) {
      const double middle = a + share * (b - a);
      const Sign there = side_at(middle);
      if (depth == 0 || there == Sign::undecided) continue;
      return count(a, from, middle, there, depth - 1) && count(middle, there, b, to, depth - 1);
    }
    return false;
  }

  const CurveOfFormulas& curve_;
  const BallVector& point_;
  int twice_ = 0;
};

class Search {
 public:
  Search(const CurveOfFormulas& curve, const FlightBetween& flight)
      : curve_(curve), flight_(flight), chord_(flight.to - flight.from) {}
  void leave_out(const Ball& end) { ends_.push_back(end); }

  /// Is the part of the curve from a to b of its length off the flight, but for the ends?
  bool is_clear(double a, double b, int depth) const {
    const double middle = 0.5 * (a + b), half = 0.5 * (b - a);
    const CurvePlace place = curve_.at(parameter_of(curve_, middle, half));
    const BallVector e = place.point - flight_.from;
    const Sign side = sign(side_of_flight(flight_.direction, flight_.curvature, e));
    if (side == Sign::positive || side == Sign::negative || is_beyond(e)) return true;
    if (passes_an_end(middle, 2.0 * half)) return true;
    if (depth == 0) return false;
    return is_clear(a, middle, depth - 1) && is_clear(middle, b, depth - 1);
  }

 private:
  /// Is a point of that line or circle off the flight? An arc lies on one side of its chord.
  bool is_beyond(const BallVector& e) const {
    const Sign turns = sign(flight_.curvature);
    if (turns != Sign::zero) {
      const Sign side = sign(cross(chord_, e));
      return turns == Sign::positive ? side == Sign::negative
                                     : turns == Sign::negative && side == Sign::positive;
    }
    const Ball along = dot(chord_, e);
    return sign(along) == Sign::negative || sign(along - dot(chord_, chord_)) == Sign::positive;
  }
  /// About there, is the only point of the line or circle an end of the flight? The curve crosses
  /// it once where the distance only grows or only falls.
  bool passes_an_end(double middle, double half) const {
    if (!curve_.periodic() && !(middle - half >= 0.0 && middle + half <= 1.0)) return false;
    const Ball about = parameter_of(curve_, middle, half), length = curve_.length();
    for (const Ball& end : ends_)
      for (const Ball& same : {end - length, end, end + length}) {
        if (!about.contains(same)) continue;
        const CurvePlace place = curve_.at(about);
        const Sign s = sign(slope_of_side(flight_.direction, flight_.curvature,
                                          place.point - flight_.from, place.first));
        return s == Sign::positive || s == Sign::negative;
      }
    return false;
  }

  const CurveOfFormulas& curve_;
  const FlightBetween& flight_;
  std::vector<Ball> ends_;
  BallVector chord_;
};

}  // namespace

std::optional<int> turns_round(const CurveOfFormulas& curve, const BallVector& point) {
  const Precision precision(128);
  return Winding(curve, point).find();
}

bool meets_nowhere_else(const CurveOfFormulas& curve, const FlightBetween& flight,
                        const std::optional<Ball>& first, const Ball& last) {
  const Precision precision(128);
  Search search(curve, flight);
  const std::array<const Ball*, 2> ends{first ? &*first : &last, &last};
  for (const Ball* end : ends) {
    // Formulas that do not repeat are no curve beyond their ends.
    if (!curve.periodic() && !(sign(*end - curve.from()) == Sign::positive &&
                               sign(curve.from() + curve.length() - *end) == Sign::positive))
      return false;
    search.leave_out(*end);
  }
  return search.is_clear(0.0, 1.0, most_halvings);
}

bool circle_meets_nothing(const CurveOfFormulas& curve, const FlightBetween& flight) {
  const Precision precision(128);
  const FlightBetween whole{flight.from, flight.from, flight.direction, flight.curvature};
  return Search(curve, whole).is_clear(0.0, 1.0, most_halvings);
}

}  // namespace carom::certify
