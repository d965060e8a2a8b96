#include "certify/flight/beside_curve.hpp"

#include <array>
#include <cmath>

namespace carom::certify {
namespace {

class Search {
 public:
  Search(const CurveOfFormulas& curve, const FlightBetween& flight, const Ball& first,
         const Ball& last)
      : curve_(curve), flight_(flight), ends_{first, last}, chord_(flight.to - flight.from) {}

  /// Is the part of the curve from a to b of its length off the flight, but for the ends?
  bool is_clear(double a, double b, int depth) const {
    const double middle = 0.5 * (a + b), half = 0.5 * (b - a);
    const CurvePlace place = curve_.at(parameter(middle, half));
    const BallVector e = place.point - flight_.from;
    const Sign side = sign(distance(place.point));
    if (side == Sign::positive || side == Sign::negative || is_beyond(e)) return true;
    if (passes_an_end(middle, 2.0 * half)) return true;
    if (depth == 0) return false;
    return is_clear(a, middle, depth - 1) && is_clear(middle, b, depth - 1);
  }

 private:
  Ball parameter(double middle, double half) const {
    const Ball share = Ball(middle).widened(Bound(half));
    return curve_.from() + share * curve_.length();
  }
  /// Zero on the line, or circle, of the flight.
  Ball distance(const BallVector& x) const {
    if (!flight_.turns) return cross(chord_, x - flight_.from);
    const BallVector e = x - flight_.centre;
    return dot(e, e) - flight_.radius2;
  }
  Ball slope(const CurvePlace& place) const {
    if (!flight_.turns) return cross(chord_, place.first);
    return Ball(2) * dot(place.point - flight_.centre, place.first);
  }
  /// Is a point of that line or circle off the flight? An arc lies on one side of its chord.
  bool is_beyond(const BallVector& e) const {
    if (flight_.turns)
      return sign(cross(chord_, e)) == (flight_.clockwise ? Sign::negative : Sign::positive);
    const Ball along = dot(chord_, e);
    return sign(along) == Sign::negative || sign(along - dot(chord_, chord_)) == Sign::positive;
  }
  /// About there, is the only point of the line or circle an end of the flight? The curve crosses
  /// it once where the distance only grows or only falls.
  bool passes_an_end(double middle, double half) const {
    if (!curve_.periodic() && !(middle - half >= 0.0 && middle + half <= 1.0)) return false;
    const Ball about = parameter(middle, half), length = curve_.length();
    for (const Ball& end : ends_)
      for (const Ball& same : {end - length, end, end + length}) {
        if (!about.contains(same)) continue;
        const Sign s = sign(slope(curve_.at(about)));
        return s == Sign::positive || s == Sign::negative;
      }
    return false;
  }

  const CurveOfFormulas& curve_;
  const FlightBetween& flight_;
  std::array<Ball, 2> ends_;
  BallVector chord_;
};

}  // namespace

bool meets_nowhere_else(const CurveOfFormulas& curve, const FlightBetween& flight,
                        const Ball& first, const Ball& last) {
  constexpr int most_halvings = 40;
  const Precision precision(128);
  const Search search(curve, flight, first, last);
  return search.is_clear(0.0, 1.0, most_halvings);
}

}  // namespace carom::certify
