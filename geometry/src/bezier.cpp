// Bézier curves: powers, tangents, lengths.
#include "carom/geometry/bezier.hpp"

#include <algorithm>
#include <stdexcept>

#include "exact_curve.hpp"
#include "gauss_legendre.hpp"
#include "rational.hpp"

namespace carom::geometry {

namespace {

/// The least |T| over the part with these control points of T. Halved until all of them lie
/// within 60 degrees of one direction; a curve without cusp comes to that.
double least_tangent(std::array<Vector, Bezier::most> d, std::size_t degree, int depth) {
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
  return std::fmin(least_tangent(left, degree, depth + 1), least_tangent(d, degree, depth + 1));
}

double length_of_part(const BezierForm& f, double from, double to) {
  return gauss_legendre(from, to, [&](double u) { return f.rate(u); });
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
  prepare_tangent(exact_curve);
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

void BezierForm::prepare_tangent(const ExactCurve& exact_curve) {
  const std::size_t n = degree;
  rests_at_start = control[0] == control[1];
  rests_at_end = control[n - 1] == control[n];
  std::array<Vector, Bezier::most> d{};  // control points of T
  for (std::size_t i = 0; i < n; ++i) d[i] = static_cast<double>(n) * (control[i + 1] - control[i]);
  tangent_degree = n - 1;
  if (!rests_at_start && !rests_at_end) {
    for (std::size_t k = 0; k < n; ++k)
      tangent_power[k] = static_cast<double>(k + 1) * power[k + 1];
    tangent_size = speed;
  } else {
    std::vector<DyadicVector> t;
    for (std::size_t k = 1; k <= n; ++k)
      t.push_back(Dyadic(static_cast<int>(k)) * exact_curve.power[k]);
    // u B(i, m - 1) = (i + 1)/m B(i + 1, m), (1 - u) B(i, m - 1) = (m - i)/m B(i, m).
    if (rests_at_start) {
      const double m = static_cast<double>(tangent_degree--);
      t.erase(t.begin());
      for (std::size_t i = 0; i + 1 < n; ++i) d[i] = (m / static_cast<double>(i + 1)) * d[i + 1];
    }
    if (rests_at_end && tangent_degree > 0) {
      const double m = static_cast<double>(tangent_degree--);
      for (std::size_t k = 1; k < t.size(); ++k) t[k] = t[k] + t[k - 1];
      t.pop_back();
      for (std::size_t i = 0; i < t.size(); ++i) d[i] = (m / (m - static_cast<double>(i))) * d[i];
    }
    for (std::size_t k = 0; k < t.size(); ++k) {
      tangent_power[k] = {nearest(t[k].x.rational()), nearest(t[k].y.rational())};
      tangent_size +=
          1.01 * std::fmax(std::fabs(tangent_power[k].x), std::fabs(tangent_power[k].y));
    }
  }
  // Control points of T are at most `tangent_size` in each coordinate. 40 halvings take at most 4
  // averages each, every one rounded by 2^-53 of that: 160 sqrt(2) 2^-53 < 2^-45 in all, and as
  // much again is for the rest. T errs by 12 * 2^-53 tangent_size in each coordinate, so that from
  // 2^-32 on the direction of a normal is known to 1.42 * 12 * 2^-21 = 2^-16.9:
  // docs/physics/exactness.md, Bézier curves.
  least_tangent = geometry::least_tangent(d, tangent_degree, 0) - 0x1p-44 * tangent_size;
  if (!(least_tangent > 0x1p-32 * tangent_size))
    throw std::invalid_argument("the Bézier curve has a cusp, or comes too near to one");
}

double BezierForm::curvature(double u) const {
  const Vector t = tangent(u);
  Vector slope;
  for (std::size_t k = tangent_degree; k > 0; --k)
    slope = static_cast<double>(k) * tangent_power[k] + u * slope;
  const double square = dot(t, t), bend = cross(t, slope) / (square * std::sqrt(square));
  // x' x x'' = w^2 T x T' with w = u^a (1 - u)^b.
  if (rests_at_start || rests_at_end)
    return bend / ((rests_at_start ? u : 1.0) * (rests_at_end ? 1.0 - u : 1.0));
  return bend;
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
