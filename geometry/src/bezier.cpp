// Bézier curves: powers, tangents, lengths.
#include "carom/geometry/bezier.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "exact_curve.hpp"
#include "gauss_legendre.hpp"
#include "rational.hpp"

namespace carom::geometry {

namespace {

/// The least |x'| over the part with these control points of x'. Halved until all of them lie
/// within 60 degrees of one direction; a curve without cusp comes to that.
double least_speed(std::array<Vector, Bezier::most> d, std::size_t degree, int depth) {
  Vector sum;
  double largest = 0.0;
  for (std::size_t i = 0; i <= degree; ++i) {
    sum = sum + d[i];
    largest = std::fmax(largest, dot(d[i], d[i]));
  }
  largest = std::sqrt(largest);
  const double norm = std::sqrt(dot(sum, sum));
  double least = HUGE_VAL;
  for (std::size_t i = 0; i <= degree; ++i) least = std::fmin(least, dot(sum, d[i]) / norm);
  if (least >= 0.5 * largest) return least;
  if (depth == 40) return 0.0;
  std::array<Vector, Bezier::most> left = d;
  for (std::size_t level = 1; level <= degree; ++level) {
    for (std::size_t k = 0; k + level <= degree; ++k) d[k] = 0.5 * (d[k] + d[k + 1]);
    left[level] = d[0];
  }
  return std::fmin(least_speed(left, degree, depth + 1), least_speed(d, degree, depth + 1));
}

double length_of_part(const BezierForm& f, double from, double to) {
  return gauss_legendre(from, to, [&](double u) {
    const Vector d = f.derivative(u);
    return std::sqrt(dot(d, d));
  });
}

}  // namespace

BezierForm::BezierForm(const Bezier& curve) : degree(static_cast<std::size_t>(curve.degree)) {
  if (curve.degree < 2 || curve.degree > Bezier::most)
    throw std::invalid_argument("a Bézier curve has a degree from 2 to 5");
  for (int i = 0; i <= curve.degree; ++i) control[static_cast<std::size_t>(i)] = curve.control(i);
  const ExactCurve exact_curve{Curve(curve)};
  power[0] = control[0];
  for (std::size_t k = 1; k <= degree; ++k) {
    power[k] = {nearest(exact_curve.power[k].x.rational()),
                nearest(exact_curve.power[k].y.rational())};
    const double size = std::fmax(std::fabs(power[k].x), std::fabs(power[k].y));
    reach += 1.01 * size;
    speed += 1.01 * static_cast<double>(k) * size;
  }
  std::array<Vector, Bezier::most> d{};
  for (std::size_t i = 0; i < degree; ++i)
    d[i] = static_cast<double>(degree) * (control[i + 1] - control[i]);
  // Control points of x' are at most `speed` in each coordinate. 40 halvings take at most 4
  // averages each, every one rounded by 2^-53 of that: 160 sqrt(2) 2^-53 < 2^-45 in all, and as
  // much again is for the rest. A tangent errs by 12 * 2^-53 speed in each coordinate, so that from
  // 2^-32 on the direction of a normal is known to 1.42 * 12 * 2^-21 = 2^-16.9:
  // docs/physics/exactness.md, Bézier curves.
  least_speed = geometry::least_speed(d, degree - 1, 0) - 0x1p-44 * speed;
  if (!(least_speed > 0x1p-32 * speed))
    throw std::invalid_argument(
        "the Bézier curve has a cusp, a control point on its end, or comes too near to that");
  for (int parts = 1;; parts *= 2) {
    const double before = lengths.empty() ? 0.0 : lengths.back();
    lengths.assign(1, 0.0);
    for (int i = 0; i < parts; ++i)
      lengths.push_back(lengths.back() + length_of_part(*this, static_cast<double>(i) / parts,
                                                        static_cast<double>(i + 1) / parts));
    // No decision: lengths are numbers that are printed. Beyond this rounding is all that changes.
    if (std::fabs(lengths.back() - before) <= 0x1p-50 * before || parts == 256) break;
  }
}

double BezierForm::curvature(double u) const {
  Vector second;
  for (std::size_t k = degree; k > 1; --k)
    second = static_cast<double>(k * (k - 1)) * power[k] + u * second;
  const Vector first = derivative(u);
  const double square = dot(first, first);
  return cross(first, second) / (square * std::sqrt(square));
}

double BezierForm::arc_length(double u) const {
  if (u >= 1.0) return lengths.back();
  const double parts = static_cast<double>(lengths.size() - 1), part = std::floor(u * parts);
  return lengths[static_cast<std::size_t>(part)] + length_of_part(*this, part / parts, u);
}

double BezierForm::area_beyond_chord() const {
  // Half the integral of d x d', d = x - x(0).
  double sum = 0.0;
  for (std::size_t j = degree; j > 1; --j)
    for (std::size_t i = 1; i < j; ++i)
      sum += static_cast<double>(j - i) / static_cast<double>(i + j) * cross(power[i], power[j]);
  return 0.5 * sum;
}

double BezierForm::parameter_near(Vector point_beside) const {
  constexpr double step = 1.0 / 32.0;
  const auto square = [&](double u) {
    const Vector e = point(u) - point_beside;
    return dot(e, e);
  };
  double u = 0.0, least = HUGE_VAL;
  for (double at = 0.0; at <= 1.0; at += step)
    if (const double d = square(at); d < least) {
      least = d;
      u = at;
    }
  // Newton's method for e.x' = 0, within a bracket that shrinks.
  double low = std::fmax(0.0, u - step), high = std::fmin(1.0, u + step);
  for (int i = 0; i < 60; ++i) {
    const Vector e = point(u) - point_beside, d = derivative(u);
    const double slope = dot(e, d);
    (slope > 0.0 ? high : low) = u;
    double next = u - slope / dot(d, d);
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::fabs(next - u) <= 0x1p-53) break;  // neighbouring doubles, or one
    u = next;
  }
  return std::clamp(u, first_parameter, std::nextafter(1.0, 0.0));
}

}  // namespace carom::geometry
