// What tests of bounds share: random flights and curves, and the largest error of each bound.
#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <map>
#include <string>
#include <utility>

#include "carom/geometry/filter.hpp"
#include "geometry/quad.hpp"
#include "random_tables.hpp"

namespace carom::tests::bounds {

using namespace geometry;

inline constexpr double u = unit_roundoff;
inline double norm_1(Vector v) { return std::fabs(v.x) + std::fabs(v.y); }

/// Largest error/bound of each name.
class Ratios {
 public:
  void add(const char* name, double error, double bound) {
    if (!(bound < HUGE_VAL)) return;
    double& largest_one = largest_[name];
    ++count_[name];
    const double ratio = error == 0.0 ? 0.0 : error / bound;
    if (!(ratio <= largest_one)) largest_one = ratio;
  }
  void add(const char* name, const Quad& value, double rounded, double bound) {
    add(name, double(magnitude(value - Quad(rounded))), bound);
  }
  void expect() const {
    for (const auto& [name, ratio] : largest_) {
      std::printf("%-34s max(error/bound) %8.5f over %ld cases\n", name.c_str(), ratio,
                  count_.at(name));
      EXPECT_LE(ratio, 1.0) << name;
      EXPECT_GT(ratio, 0.005) << name;  // compilers draw numbers in another order: .0077 was seen
    }
  }

 private:
  std::map<std::string, double> largest_;
  std::map<std::string, long> count_;
};

/// A flight of some size whose exact start lies within `delta` of the rounded one.
struct Sample {
  double size = 1.0;
  Vector start, velocity;
  QuadVector exact_start;
  double square = 1.0;  // rounded |v|^2, as a constant of the motion
  FlightScale scale;
  double omega = 0.0;

  Sample(Dice& dice, bool exact, double of_size) : size(of_size) {
    start = size * Vector{dice.between(-1, 1), dice.between(-1, 1)};
    const double speed = dice.spread(1e-3, 1e3);
    velocity =
        speed * (dice.whole(0, 5) == 0 ? Vector{1.0, 0x1p-30 * dice.unit()} : dice.direction());
    if (dice.coin()) std::swap(velocity.x, velocity.y);
    omega = dice.whole(0, 3) == 0
                ? 0.0
                : dice.sign() *
                      (dice.coin() ? dice.spread(1e-6, 1e6) : dice.spread(0.1, 10) * speed / size);
    scale = {exact ? 0.0 : dice.spread(u, 100 * u) * size, norm_1(velocity), std::fabs(omega), 1.0};
    exact_start = quad(start) + QuadVector{Quad(scale.delta) * Quad(dice.sign()),
                                           Quad(scale.delta) * Quad(dice.sign())};
    square = dot(velocity, velocity) * (1.0 + 60.0 * u * dice.whole(-1, 1));
  }
};

inline double random_size(Dice& dice) { return dice.spread(1e-6, 1e6); }

/// A curve and what is made of it; many flights see it.
struct Scene {
  double size;
  Curve curve;
  PreparedCurve rounded;
  QuadCurve exact;
  Scene(double of_size, const Curve& c) : size(of_size), curve(c), rounded(c), exact(c) {}
};

/// Rounding alone, and a start that is known to `delta`. `make` builds a scene, `measure` adds to
/// the ratios.
template <class Make, class Measure>
void sweep(const char* what, Make&& make, Measure&& measure) {
  for (const bool exact : {true, false}) {
    std::printf("%s, %s\n", what, exact ? "rounding alone" : "start within delta");
    Dice dice(exact ? 3 : 4);
    Ratios ratios;
    constexpr int flights = 25;
    for (long left = cases(40000, 10000000); left > 0; left -= flights) {
      const double size = random_size(dice);
      const Scene scene(size, make(size, dice));
      for (int i = 0; i < flights; ++i) measure(Sample(dice, exact, size), scene, dice, ratios);
    }
    ratios.expect();
  }
}

/// A place about as far away as the size, or much nearer.
inline Vector place(double size, Dice& dice) {
  return (dice.spread(1e-3, 2.0) * size) * dice.direction();
}

inline Curve random_segment(double size, Dice& dice) {
  return Segment{place(size, dice), place(size, dice)};
}
/// Flat and full ones too.
inline Curve random_circle(double size, Dice& dice) {
  if (dice.coin()) return Circle{place(size, dice), size * dice.spread(1e-3, 1.0), dice.coin()};
  const double offset = dice.sign() * (dice.coin() ? dice.between(0, 2) : dice.spread(1, 1e6));
  return CircularArc{place(size, dice), place(size, dice), offset, dice.coin()};
}
inline Curve random_ellipse(double size, Dice& dice) {
  const double ratio = dice.spread(0.05, 1.0);
  if (dice.coin())
    return Ellipse{place(size, dice), size * dice.spread(1e-2, 1.0) * dice.direction(), ratio,
                   dice.coin()};
  const double offset = dice.sign() * (dice.coin() ? dice.between(0, 2) : dice.spread(1, 1e4));
  return EllipticArc{place(size, dice), place(size, dice), dice.direction(), ratio, offset,
                     dice.coin()};
}

}  // namespace carom::tests::bounds
