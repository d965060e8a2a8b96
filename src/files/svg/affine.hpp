// Transforms of a drawing, exact except for the cosines and sines of turns, which are doubles.
#pragma once

#include "files/svg/numbers.hpp"

namespace carom::files {

struct DrawnPoint {
  Rational x, y;

  friend bool operator==(const DrawnPoint&, const DrawnPoint&) = default;
  friend DrawnPoint operator+(const DrawnPoint& a, const DrawnPoint& b) {
    return {a.x + b.x, a.y + b.y};
  }
  friend DrawnPoint operator-(const DrawnPoint& a, const DrawnPoint& b) {
    return {a.x - b.x, a.y - b.y};
  }
};

/// (x, y) -> (a x + c y + e, b x + d y + f), in the order in which drawings write it.
struct Affine {
  Rational a = 1, b = 0, c = 0, d = 1, e = 0, f = 0;

  DrawnPoint operator()(const DrawnPoint& p) const {
    return {a * p.x + c * p.y + e, b * p.x + d * p.y + f};
  }
  /// Without the displacement.
  DrawnPoint linear(const DrawnPoint& p) const { return {a * p.x + c * p.y, b * p.x + d * p.y}; }
  Rational determinant() const { return a * d - b * c; }
  Affine inverse() const;
  /// First the other, then this.
  Affine after(const Affine& first) const;
};

/// The turn by an angle in degrees; exact for multiples of 90.
Affine turn(const Rational& degrees);

/// Refuses a transform that has no inverse, or numbers of a size with which exact arithmetic gets
/// slow.
void check_size(const Affine&, const Place&);

/// The value of an attribute `transform`.
Affine transform_of(const XmlAttribute&, const Locator&);

/// What the unit circle becomes: semi-axes as squares, and the angle of the first in radians.
struct Axes {
  Rational square_a, square_b;
  ExactNumber angle;
  bool circle() const { return square_a == square_b; }
};
/// `a` is along x where the axes are along x and y, else it is the larger one.
Axes axes_of(const Affine&, const Place&);

}  // namespace carom::files
