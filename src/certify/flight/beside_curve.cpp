#include "certify/flight/beside_curve.hpp"

#include <cmath>
#include <vector>

#include "carom/base/elementary.hpp"

namespace carom::certify {
namespace {

constexpr int most_halvings = 40;

/// Of the points about the middle of a part of the piece's length.
Ball parameter_of(const Piece& piece, double middle, double half) {
  return piece.from + Ball(middle).widened(Bound(half)) * piece.length;
}

/// Counts crossings of a ray from a point, by sides of it.
class Winding {
 public:
  Winding(const Piece& piece, const BallVector& point) : piece_(piece), point_(point) {}

  /// Twice what the piece has of a turn: +1 or -1 for each crossing.
  std::optional<int> find() {
    const Sign from = side_at(0.0), to = piece_.periodic ? from : side_at(1.0);
    if (from == Sign::undecided || to == Sign::undecided ||
        !count(0.0, from, 1.0, to, most_halvings))
      return {};
    return twice_;
  }

 private:
  // In a direction that no curve has for its axis.
  BallVector seen(const BallVector& x) const {
    const BallVector e = x - point_, ray{Ball(0x1.8p0), Ball(0x1.1caf2p0)};
    return {dot(ray, e), cross(ray, e)};
  }
  /// Of the ray. Behind its start any side will do.
  Sign side_at(double share) const {
    const BallVector e = seen(piece_.at(parameter_of(piece_, share, 0.0)).point);
    const Sign side = sign(e.y);
    if (side == Sign::positive || side == Sign::negative) return side;
    return sign(e.x) == Sign::negative ? Sign::positive : Sign::undecided;
  }
  bool count(double a, Sign from, double b, Sign to, int depth) {
    const double half = 0.5 * (b - a) + 0x1p-52;  // more than rounding takes from parts of [0, 1]
    const BallVector e = seen(piece_.at(parameter_of(piece_, 0.5 * (a + b), half)).point);
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

  const Piece& piece_;
  const BallVector& point_;
  int twice_ = 0;
};

/// Along a piece, in parts of its length.
class Search {
 public:
  Search(const Piece& piece, const FlightBetween& flight) : piece_(piece), flight_(flight) {}
  void leave_out(const Ball& end) { ends_.push_back(end); }

  /// Is the part from a to b off the flight, except the ends?
  bool is_clear(double a, double b, int depth = most_halvings) {
    const double middle = 0.5 * (a + b), half = 0.5 * (b - a);
    Sign slope{};
    if (is_off(middle, half, slope) || passes_an_end(middle, 2.0 * half)) return true;
    if (depth == 0 || --parts_left_ < 0) return false;
    return is_clear(a, middle, depth - 1) && is_clear(middle, b, depth - 1);
  }

  /// Gives parts to `offer` in which the line or circle leaves the domain once, or not at all.
  void find_exits(double a, double b, const auto& offer, int depth = most_halvings) {
    const double middle = 0.5 * (a + b), half = 0.5 * (b - a);
    Sign slope{};
    if (is_off(middle, half, slope)) return;
    if (slope != Sign::undecided && slope != Sign::zero) {
      if ((slope == Sign::positive) == (piece_.turn > 0.0)) offer(a, b);
    } else if (depth > 0 && --parts_left_ >= 0) {
      find_exits(a, middle, offer, depth - 1);
      find_exits(middle, b, offer, depth - 1);
    }
  }

 private:
  Ball side(const CurvePlace& place) const {
    return side_of_flight(flight_.direction, flight_.curvature, place.point - flight_.from);
  }
  Ball slope(const CurvePlace& place) const {
    return slope_of_side(flight_.direction, flight_.curvature, place.point - flight_.from,
                         place.first);
  }
  /// Is a part off the flight? If that is not seen: does the side only rise there, or only fall?
  bool is_off(double middle, double half, Sign& slope_there) const {
    const auto decided = [](Sign s) { return s == Sign::positive || s == Sign::negative; };
    const auto side_at = [&](const Ball& t) { return side(piece_.at(t)); };
    const Ball about = parameter_of(piece_, middle, half);
    const CurvePlace place = piece_.at(about);
    if (decided(sign(side(place))) || is_beyond(place.point - flight_.from)) return true;
    const Ball rate = slope(place), at = parameter_of(piece_, middle, 0.0);
    slope_there = sign(rate);
    if (!decided(slope_there)) return decided(sign(side_at(at) + (about - at) * rate));
    // It lies between those at the ends.
    const Sign begin = sign(side_at(parameter_of(piece_, middle - half, 0.0)));
    return decided(begin) && begin == sign(side_at(parameter_of(piece_, middle + half, 0.0)));
  }
  /// Is a point of that line or circle off the flight? An arc lies on one side of its chord.
  bool is_beyond(const BallVector& e) const {
    const Sign turns = sign(flight_.curvature);
    const bool ends = flight_.to.has_value();
    if (turns != Sign::zero && !ends) return false;
    const BallVector chord = ends ? *flight_.to - flight_.from : flight_.direction;
    if (turns != Sign::zero) {
      const Sign side = sign(cross(chord, e));
      return turns == Sign::positive ? side == Sign::negative
                                     : turns == Sign::negative && side == Sign::positive;
    }
    const Ball along = dot(chord, e);
    return sign(along) == Sign::negative ||
           (ends && sign(along - dot(chord, chord)) == Sign::positive);
  }
  /// About there, is the only point of the line or circle an end of the flight? The curve crosses
  /// it once where the distance only grows or only falls.
  bool passes_an_end(double middle, double half) const {
    const Ball about = parameter_of(piece_, middle, half);
    for (const Ball& end : ends_)
      for (const int rounds : {-1, 0, 1}) {
        // What does not repeat is no curve beyond its ends.
        if ((rounds != 0 && !piece_.periodic) ||
            !about.contains(end + Ball(rounds) * piece_.length))
          continue;
        const Sign s = sign(slope(piece_.at(about)));
        return s == Sign::positive || s == Sign::negative;
      }
    return false;
  }

  const Piece& piece_;
  const FlightBetween& flight_;
  std::vector<Ball> ends_;
  int parts_left_ = 1 << 16;  ///< to look at: along a wall it would be 2^40
};

/// The parameter in a part at which a flight passes from one side of the curve's point to the
/// other, by Newton's steps in doubles that do not leave it.
std::optional<double> crossing(const Piece& piece, const FlightBetween& flight, double from,
                               double to) {
  const auto side = [&](const CurvePlace& p) {
    return side_of_flight(flight.direction, flight.curvature, p.point - flight.from).to_double();
  };
  double before = parameter_of(piece, from, 0.0).to_double(),
         after = parameter_of(piece, to, 0.0).to_double();
  if (piece.turn < 0.0) std::swap(before, after);
  // With all bits: which of two pieces a flight meets beside their joint.
  if (!(side(piece.at(before)) <= 0.0 && side(piece.at(after)) >= 0.0)) return {};
  const Precision precision(64);
  double t = before + 0.5 * (after - before);
  for (int n = 0; n < 100; ++n) {
    const CurvePlace place = piece.at(t);
    const double value = side(place);
    (value < 0.0 ? before : after) = t;
    double next = t - value / slope_of_side(flight.direction, flight.curvature,
                                            place.point - flight.from, place.first)
                                  .to_double();
    const bool within =
        before < after ? before < next && next < after : after < next && next < before;
    if (!within) next = before + 0.5 * (after - before);
    const bool done = std::fabs(next - t) <= 0x1p-45 * std::fabs(piece.length.to_double());
    t = next;
    if (done) break;
  }
  return t;
}

}  // namespace

std::optional<Pieces::Spot> first_exit(const Pieces& pieces, const FlightBetween& flight) {
  const slong bits = Precision::bits();
  const Precision precision(64);
  const geometry::Vector d = in_doubles(flight.direction);
  const double k = flight.curvature.to_double();
  double first = HUGE_VAL;
  std::optional<Pieces::Spot> found;
  for (std::size_t n = 0; n < pieces.size(); ++n)
    Search(pieces[n], flight).find_exits(0.0, 1.0, [&](double a, double b) {
      const Precision all(bits);
      const std::optional<double> t = crossing(pieces[n], flight, a, b);
      if (!t) return;
      const geometry::Vector e = in_doubles(pieces[n].at(*t).point - flight.from);
      // By half of the angle that the flight has turned by, or by its length.
      const double along = dot(d, e);
      const double way =
          k == 0.0 ? along : elementary::atan2(std::copysign(1.0, k) * cross(e, d), along);
      if (!(way > 0.0 && way < first)) return;
      first = way;
      found = {n, *t};
    });
  return found;
}

std::optional<int> turns_round(const Pieces& pieces, const BallVector& point) {
  const Precision precision(128);
  int twice = 0;
  for (std::size_t n = 0; n < pieces.size(); ++n) {
    const std::optional<int> part = Winding(pieces[n], point).find();
    if (!part) return {};
    twice += pieces[n].turn > 0.0 ? *part : -*part;
  }
  return twice / 2;
}

bool meets_nowhere_else(const Pieces& pieces, const FlightBetween& flight,
                        const std::optional<Pieces::Spot>& first,
                        const std::optional<Pieces::Spot>& last) {
  const Precision precision(128);
  for (std::size_t n = 0; n < pieces.size(); ++n) {
    const Piece& piece = pieces[n];
    Search search(piece, flight);
    for (const auto* end : {&first, &last}) {
      if (!*end || (*end)->piece != n) continue;
      const Ball& t = (*end)->t;
      if (!piece.periodic && !(sign(t - piece.from) == Sign::positive &&
                               sign(piece.from + piece.length - t) == Sign::positive))
        return false;
      search.leave_out(t);
    }
    if (!search.is_clear(0.0, 1.0)) return false;
  }
  return true;
}

}  // namespace carom::certify
