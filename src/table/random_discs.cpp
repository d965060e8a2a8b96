// Discs at random places that do not overlap: the random Lorentz gas.
#include <algorithm>
#include <cmath>

#include "carom/base/random.hpp"
#include "carom/base/whole_number.hpp"
#include "carom/geometry/lattice.hpp"
#include "table/flat_arcs.hpp"
#include "table/numbers.hpp"
#include "table/shapes.hpp"

namespace carom::table::shapes {
namespace {

using geometry::Circle;
using geometry::Vector;

constexpr std::uint64_t most_discs = 1'000'000;  // half a gigabyte
constexpr std::uint64_t most_seed = std::uint64_t{1} << 53;
constexpr int most_draws = 1'000'000;                     // of one disc
constexpr std::uint64_t most_draws_of_all = 100'000'000;  // some seconds

// u is the rounding of one operation.
constexpr double u = 0x1p-53;
// Bound of the errors of lengths in a square, in units of its side. A difference of two coordinates
// errs by u, and by another u when the side is subtracted from it: their distance by 2 sqrt(2) u. A
// drawn coordinate errs by u for the range, the product and the sum each. More than twice the sum.
constexpr double rounding = 8.0 * u;
// The same for squared distances, relative: two squares, their sum and the square of the reach make
// 4 u, times eight.
constexpr double rounding_of_squares = 32.0 * u;
// Keeps the rounding of a square's width from making it too narrow for a reach.
constexpr double narrower = 0.999;

std::uint64_t whole_number_from(const ExactNumber& value, std::uint64_t least, std::uint64_t most) {
  const auto number = whole_number(value, least, most);
  if (!number)
    throw InputError(value.place(),
                     "must be a whole number from " + std::to_string(least) + " to " +
                         std::to_string(most) + ", not " + value.text(),
                     "a whole number");
  return *number;
}

/// Places in a square [0, side]^2 one after the other, each drawn until it has room. Squares at
/// least as wide as two radii hold the numbers of the discs whose centres are in them, so that
/// neighbours alone are asked.
class Arrangement {
 public:
  Arrangement(double side, double radius, std::size_t count, bool torus)
      : side_(side),
        torus_(torus),
        // A difference of coordinates, and a side taken off it, are rounded: so discs are really
        // apart.
        reach_(2.0 * radius + rounding * side) {
    const double fitting = std::floor(narrower * side / reach_),
                 enough = std::ceil(std::sqrt(static_cast<double>(count)));
    parts_ = static_cast<int>(std::fmax(1.0, std::fmin(fitting, enough)));
    squares_.resize(static_cast<std::size_t>(parts_) * static_cast<std::size_t>(parts_));
  }

  bool fits(Vector x) const {
    const int i = part(x.x), k = part(x.y);
    // Most draws that do not fit are near a disc of their own square, so that it is asked first.
    static constexpr int about[] = {0, -1, 1};
    // Fewer than four squares in a row: the same ones would be asked twice.
    const int squares = std::min(parts_, 3);
    for (int a = 0; a < squares; ++a)
      for (int b = 0; b < squares; ++b)
        for (const std::size_t other : squares_[index(i + about[a], k + about[b])])
          if (near(x, placed_[other])) return false;
    return true;
  }
  void place(Vector x) {
    squares_[index(part(x.x), part(x.y))].push_back(placed_.size());
    placed_.push_back(x);
  }
  const std::vector<Vector>& placed() const { return placed_; }

 private:
  int part(double x) const { return std::min(static_cast<int>(x / side_ * parts_), parts_ - 1); }
  std::size_t index(int i, int k) const {
    const auto around = [&](int n) { return static_cast<std::size_t>((n + parts_) % parts_); };
    return around(i) + static_cast<std::size_t>(parts_) * around(k);
  }
  double shortest(double d) const {
    d = std::fabs(d);
    return torus_ ? std::fmin(d, side_ - d) : d;
  }
  bool near(Vector a, Vector b) const {
    const double x = shortest(a.x - b.x), y = shortest(a.y - b.y);
    return x * x + y * y <= reach_ * reach_ * (1.0 + rounding_of_squares);
  }

  double side_;
  bool torus_;
  double reach_;
  int parts_ = 1;
  std::vector<std::vector<std::size_t>> squares_;
  std::vector<Vector> placed_;
};

}  // namespace

Shape random_discs(const TableSpec& spec) {
  const double side = size(spec, "side");
  const ExactNumber& radius_number = number(spec, "radius");
  const double radius = size_of(radius_number, "radius");
  const ExactNumber& count_number = number(spec, "count");
  const std::uint64_t count = whole_number_from(count_number, 1, most_discs);
  const std::uint64_t seed = whole_number_from(number_or(spec, "seed", "1"), 0, most_seed);
  if (!(4 * radius < side)) {
    throw InputError(radius_number.place(), "the discs are too large for the square",
                     "radius < side/4");
  }
  // No packing of a torus is denser than the triangular lattice, pi/sqrt(12) = 0.9069 (Fejes Toth
  // 1940).
  if (const double discs = static_cast<double>(count), share = radius / side;
      3.1415 * discs * share * share > 0.907)
    throw InputError(count_number.place(),
                     "the discs would fill more of the square than the densest packing does",
                     "fewer or smaller discs: placed one after the other they fill about half of "
                     "the area");
  // Placed one after the other, discs fill .547 of a torus at most (Hinrichsen, Feder, Jossang
  // 1986). With these draws 16 arrangements of 1000 filled .541 with a deviation of .005, which
  // falls as 1/sqrt(count): for 10 000 .56 is more than ten deviations away.
  if (const double discs = static_cast<double>(count), share = radius / side;
      discs >= 10000 && 3.1415 * discs * share * share > 0.56)
    throw InputError(count_number.place(),
                     "the discs would fill more of the square than discs placed one after the "
                     "other can",
                     "fewer or smaller discs: at most about half of the area");
  // Discs that no place in the square allows are refused before any is placed.
  Wall first;
  first.name = "disc_1";
  first.curve = Circle{{0.5 * side, 0.5 * side}, radius, false};
  if (const Misplaced found = misplaced(first, {side, 0.5 * side}); !found.fault.empty())
    throw InputError(radius_number.place(), found.fault, found.expected);
  // Between walls a disc keeps off them by the margin that it keeps from others.
  const double margin = spec.torus ? 0.0 : radius + rounding * side;
  Arrangement arrangement(side, radius, count, spec.torus);
  std::uint64_t draws_of_all = 0;
  for (std::uint64_t disc = 0; disc < count; ++disc) {
    RandomStream random(seed, Purpose::arrangement, disc);
    int draws = 0;
    for (;;) {
      const double x = margin + random.uniform() * (side - 2.0 * margin);
      const double y = margin + random.uniform() * (side - 2.0 * margin);
      if (arrangement.fits({x, y})) {
        arrangement.place({x, y});
        break;
      }
      if (++draws == most_draws || ++draws_of_all == most_draws_of_all) {
        throw InputError(
            count_number.place(),
            "no room was found for disc " + std::to_string(disc + 1) + " of " +
                std::to_string(count),
            "fewer or smaller discs: placed one after the other they fill about half of the area");
      }
    }
  }
  const std::vector<std::string> names = numbered("disc", count);
  Shape shape;
  for (std::size_t k = 0; k < names.size(); ++k) {
    const Vector centre = arrangement.placed()[k];  // drawn as doubles, it is these exactly
    shape.loops.push_back({{names[k], WrittenCircle{{centre.x, centre.y}, radius_number, false}}});
  }
  close_square(shape, number(spec, "side"), spec);
  return shape;
}

}  // namespace carom::table::shapes
