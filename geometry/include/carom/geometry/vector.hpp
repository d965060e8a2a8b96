// Vectors of the plane.
#pragma once

#include <cmath>

namespace carom::geometry {

/// A vector or point of the plane over any arithmetic.
template <class Number>
struct BasicVector {
  Number x{}, y{};

  friend constexpr BasicVector operator+(const BasicVector& a, const BasicVector& b) {
    return {a.x + b.x, a.y + b.y};
  }
  friend constexpr BasicVector operator-(const BasicVector& a, const BasicVector& b) {
    return {a.x - b.x, a.y - b.y};
  }
  friend constexpr BasicVector operator-(const BasicVector& a) { return {-a.x, -a.y}; }
  friend constexpr BasicVector operator*(const Number& s, const BasicVector& a) {
    return {s * a.x, s * a.y};
  }
  friend bool operator==(const BasicVector&,
                         const BasicVector&) = default;  // constexpr where it can be
};

using Vector = BasicVector<double>;

template <class Number>
constexpr Number dot(const BasicVector<Number>& a, const BasicVector<Number>& b) {
  return a.x * b.x + a.y * b.y;
}
template <class Number>
constexpr Number cross(const BasicVector<Number>& a, const BasicVector<Number>& b) {
  return a.x * b.y - a.y * b.x;
}
inline double length(const Vector& a) { return std::sqrt(dot(a, a)); }
/// A quarter turn counter-clockwise.
template <class Number>
constexpr BasicVector<Number> left(const BasicVector<Number>& a) {
  return {-a.y, a.x};
}
/// A quarter turn clockwise: the J of the magnetic force, a = omega J v.
template <class Number>
constexpr BasicVector<Number> right(const BasicVector<Number>& a) {
  return {a.y, -a.x};
}

}  // namespace carom::geometry
