#include "forces/bump_series.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "carom/base/elementary.hpp"

namespace carom::forces {

using geometry::Vector;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double pi = 0x1.921fb54442d18p1;
constexpr std::size_t orders = LatticeSum::most_degree + 1;
using Series = std::array<double, orders>;  // by powers of s - s0, s = r^2

/// The largest |V| on the disc of complex distances about r of radius rho < r.
double largest_fermi(const BumpShape& shape, double r, double rho) {
  const double z = (r - shape.radius) / shape.softness, reach = rho / shape.softness;
  const double decay = std::min(1.0, elementary::exp(reach - z));
  // |1 + e^w| >= max(1, |e^w|) sin(theta) where |Im w| <= theta, pi/2 <= theta < pi.
  double largest = infinity;
  if (reach < pi) largest = decay / elementary::sin(std::max(reach, 0.5 * pi));
  // Farther off the axis Re w is at least z - sqrt(reach^2 - theta^2), and |1 + e^w| >= e^(Re w)
  // - 1.
  for (const double theta : {1.8, 2.2, 2.5, 2.8}) {
    if (!(reach > theta)) continue;
    const double beyond = z - std::sqrt(reach * reach - theta * theta);
    if (!(beyond > 0.0)) continue;
    largest = std::min(
        largest, std::max(decay / elementary::sin(theta), 1.0 / (elementary::exp(beyond) - 1.0)));
  }
  return largest;
}

/// Re r^2 >= r^2 - 2 r rho - rho^2 there.
double largest_gaussian(const BumpShape& shape, double r, double rho) {
  return elementary::exp((rho * (2.0 * r + rho) - r * r) / (2.0 * shape.width * shape.width));
}

Series fermi_series(const BumpShape& shape, double s0, int degree) {
  // s r' = r/2, and V' = -V (1 - V) r'/softness.
  Series r{}, slope{}, v{}, w{};
  r[0] = std::sqrt(s0);
  for (int k = 0; k < degree; ++k) {
    const auto i = static_cast<std::size_t>(k);
    r[i + 1] = (0.5 - k) * r[i] / (s0 * (k + 1));
    slope[i] = (k + 1) * r[i + 1] / -shape.softness;
  }
  const double e = elementary::exp(std::min((r[0] - shape.radius) / shape.softness, 300.0));
  v[0] = 1.0 / (1.0 + e);
  const double complement = v[0] * e;  // 1 - V, without cancellation
  for (int k = 0; k < degree; ++k) {
    const auto n = static_cast<std::size_t>(k);
    w[n] = v[n] * (n == 0 ? complement : complement - v[0]);
    for (std::size_t m = 1; m < n; ++m) w[n] -= v[m] * v[n - m];
    double sum = 0.0;
    for (std::size_t m = 0; m <= n; ++m) sum += slope[m] * w[n - m];
    v[n + 1] = sum / (k + 1);
  }
  return v;
}

Series gaussian_series(const BumpShape& shape, double s0, int degree) {
  Series v{};
  const double rate = -0.5 / (shape.width * shape.width);
  v[0] = elementary::exp(rate * s0);
  for (int k = 0; k < degree; ++k)
    v[static_cast<std::size_t>(k) + 1] = v[static_cast<std::size_t>(k)] * rate / (k + 1);
  return v;
}

}  // namespace

SeriesErrors series_errors(const BumpShape& shape, double r, double way) {
  const bool fermi = shape.kind == BumpShape::Kind::fermi;
  SeriesErrors least;
  least.fill(infinity);
  // Any rho gives a bound.
  double rho = fermi ? 0.97 * r : r + 12.0 * shape.width;
  for (int k = 0; k < 24 && rho > 1.5 * way; ++k, rho *= 0.87) {
    const double largest = fermi ? largest_fermi(shape, r, rho) : largest_gaussian(shape, r, rho);
    if (!(largest < 1e30)) continue;
    const double x = way / rho;
    double last = largest / (1.0 - x);  // times x^n
    for (int n = 0; n <= LatticeSum::most_degree; ++n, last *= x) {
      const double gradient = shape.length() / rho * last * (n + 1 - n * x) / (1.0 - x);
      double& bound = least[static_cast<std::size_t>(n)];
      bound = std::min(bound, std::max(last * x, gradient));
    }
  }
  return least;
}

void add_series(const BumpShape& shape, Vector d, Vector a, Vector b, int degree, std::size_t width,
                std::vector<double>& to) {
  const double s0 = dot(d, d);
  const Series g = shape.kind == BumpShape::Kind::fermi ? fermi_series(shape, s0, degree)
                                                        : gaussian_series(shape, s0, degree);
  // s - s0 = x X + y Y + xx X^2 + xy X Y + yy Y^2, put into the series by Horner's rule. What is to
  // be multiplied k more times is needed up to degree - k only.
  const double x = 2.0 * dot(d, a), y = 2.0 * dot(d, b), xx = dot(a, a), xy = 2.0 * dot(a, b),
               yy = dot(b, b);
  std::array<std::array<double, orders>, orders> now, next;  // [power of Y][power of X]
  const auto rows = static_cast<std::size_t>(degree) + 1;
  for (std::size_t j = 0; j < rows; ++j)
    for (std::size_t i = 0; i + j < rows; ++i) now[j][i] = next[j][i] = 0.0;
  now[0][0] = g[static_cast<std::size_t>(degree)];
  for (int k = degree - 1; k >= 0; --k) {
    const int most = degree - k;
    for (int j = 0; j <= most; ++j)
      for (int i = 0; i + j <= most; ++i) {
        const auto m = static_cast<std::size_t>(j), n = static_cast<std::size_t>(i);
        double sum = 0.0;
        if (i > 0) sum += x * now[m][n - 1];
        if (j > 0) sum += y * now[m - 1][n];
        if (i > 1) sum += xx * now[m][n - 2];
        if (i > 0 && j > 0) sum += xy * now[m - 1][n - 1];
        if (j > 1) sum += yy * now[m - 2][n];
        next[m][n] = sum;
      }
    next[0][0] = g[static_cast<std::size_t>(k)];
    std::swap(now, next);
  }
  for (std::size_t j = 0; j < rows; ++j)
    for (std::size_t i = 0; i + j < rows; ++i) to[i + width * j] += now[j][i];
}

}  // namespace carom::forces
