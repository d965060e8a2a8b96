#include "carom/geometry/bezier_flight.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "carom/geometry/bernstein.hpp"
#include "curve_exit.hpp"
#include "number_with_error.hpp"

namespace carom::geometry {

namespace {

constexpr std::size_t most = Bezier::most;
using Powers = std::array<double, most + 1>;
/// Two doubles side by side, each rounded by itself.
using Pair [[gnu::vector_size(16)]] = double;

double norm_1(Vector v) { return std::fabs(v.x) + std::fabs(v.y); }

/// Differences of what follows each other.
struct Steps {
  double least = HUGE_VAL, most = -HUGE_VAL;
  void add(double step) {
    least = std::min(least, step);
    most = std::max(most, step);
  }
  /// Do all rise by more than that, or all fall?
  Sign trend(double hidden) const {
    return least > hidden ? Sign::positive : most < -hidden ? Sign::negative : Sign::undecided;
  }
};

/// The line as polynomials in u: g = v x (x(u) - start), which rises where the line leaves the
/// domain, and a = v . (x(u) - start). Standing on the curve both are divided by u - on, and their
/// highest power is none.
template <std::size_t degree>
class Line {
  // Loops over powers are unrolled, or counting costs as much as they do.
 public:
  Line(const BezierForm& curve, Vector start, Vector v, const FlightScale& scale, double on);

  bool on_curve() const { return on_ >= 0.0; }
  double on() const { return on_; }
  BernsteinPolynomial<NumberWithError, most> bernstein() const;
  /// Not standing on the curve.
  Course course() const {
    Steps steps;
    double last = across_[0];
#pragma GCC unroll 8
    for (std::size_t i = 1; i <= degree; ++i) {
      const double g = cross(v_, curve_.control[i] - start_);
      steps.add(g - last);
      last = g;
    }
    // Control points are within `reach` of the first in each coordinate.
    const double error = coefficient_error(norm_1(curve_.control[0] - start_) + 2.0 * curve_.reach);
    return {steps.trend(6.0 * error), across_[0], last, error};
  }
  bool surely_missed() const;
  double error() const { return error_; }
  double value(double u) const { return at(u).value; }
  /// Both by Horner's rule, side by side.
  Local at(double u) const {
    Pair sum = local_[degree];
#pragma GCC unroll 8
    for (std::size_t k = 1; k <= degree; ++k) sum = local_[degree - k] + Pair{u, u} * sum;
    return {sum[0], sum[1]};
  }
  /// The exit at a root that u misses by at most `spread`: none if it lies behind.
  CurveExit exit_at(double u, double spread) const;
  static bool is_before(double place, double other) { return place < other; }

 private:
  double coefficient_error(double distance) const {
    return scale_.inflation * 1.01 * norm_1(v_) * (scale_.delta + 4.1 * unit_roundoff * distance);
  }
  NumberWithError coefficient(std::size_t i) const {
    const Vector d = curve_.control[i] - start_;
    return {cross(v_, d), coefficient_error(norm_1(d))};
  }

  const BezierForm& curve_;
  const FlightScale& scale_;
  Vector start_, v_;
  double on_, size_;
  Powers across_{}, along_{};
  std::array<Pair, most + 1> local_;  // across_[k] and (k + 1) across_[k + 1]
  double error_ = 0.0;                // of a value of both
  double along_slope_ = 0.0;          // bounds that of a
};

template <std::size_t degree>
Line<degree>::Line(const BezierForm& curve, Vector start, Vector v, const FlightScale& scale,
                   double on)
    : curve_(curve), scale_(scale), start_(start), v_(v), on_(on), size_(norm_1(v) * curve.reach) {
  constexpr double u = unit_roundoff, n = degree;
#pragma GCC unroll 8
  for (std::size_t k = 1; k <= degree; ++k) {
    across_[k] = cross(v, curve.power[k]);
    along_[k] = dot(v, curve.power[k]);
  }
  if (!on_curve()) {
    const NumberWithError first = coefficient(0);
    across_[0] = first.value;
    along_[0] = dot(v, curve.control[0] - start);
    // A coefficient errs by 3u of |v|_1 |power|, Horner's rule by 2u a step.
    error_ = first.error + scale.inflation * (2.0 * n + 4.1) * u * size_;
    along_slope_ = norm_1(v) * curve.speed;
  } else {
    // Coefficient j is the sum of power[k] on^(k - 1 - j) over k > j: with 2u a step and what the
    // powers err by (2 n + 3)u; all of them together sum at most n |v|_1 reach.
    for (Powers* p : {&across_, &along_}) {
      for (std::size_t k = degree - 1; k > 0; --k) (*p)[k] += on * (*p)[k + 1];
      for (std::size_t k = 0; k < degree; ++k) (*p)[k] = (*p)[k + 1];
      (*p)[degree] = 0.0;
    }
    error_ = scale.inflation * (4.0 * n + 4.1) * u * n * size_;
    along_slope_ = n * n * size_;
  }
#pragma GCC unroll 8
  for (std::size_t k = 0; k < degree; ++k)
    local_[k] = Pair{across_[k], static_cast<double>(k + 1) * across_[k + 1]};
  local_[degree] = Pair{across_[degree], 0.0};
}

template <std::size_t degree>
BernsteinPolynomial<NumberWithError, most> Line<degree>::bernstein() const {
  constexpr double u = unit_roundoff, n = degree;
  if (!on_curve()) {
    BernsteinPolynomial<NumberWithError, most> g;
    g.degree = degree;
    for (std::size_t i = 0; i <= degree; ++i) g.b[i] = coefficient(i);
    return g;
  }
  std::array<NumberWithError, most + 1> c;
  for (std::size_t k = 0; k < degree; ++k)
    c[k] = {across_[k], scale_.inflation * (2.0 * n + 3.1) * u * size_};
  auto g = bernstein_form<most>(c, degree - 1, share_of);
  for (std::size_t k = 0; k < degree; ++k)
    g.b[k].error += scale_.inflation * 7.1 * u * n * size_;  // roundings count whatever it is
  return g;
}

/// Most curves that are asked are missed or lie behind, and most of those that flights begin on are
/// left for good: by signs alone.
template <std::size_t degree>
bool Line<degree>::surely_missed() const {
  double least = HUGE_VAL, largest = -HUGE_VAL, ahead = -HUGE_VAL, farthest = 0.0;
  // Standing on the curve g / (u - on) = v x (a mean of x'), and x' lies in the hull of the
  // differences of control points; there it is negative.
  for (std::size_t i = on_curve() ? 1 : 0; i <= degree; ++i) {
    const Vector d = curve_.control[i] - (on_curve() ? curve_.control[i - 1] : start_);
    const double g = cross(v_, d);
    least = std::min(least, g);
    largest = std::max(largest, g);
    ahead = std::max(ahead, dot(v_, d));
    farthest = std::max(farthest, norm_1(d));
  }
  const double error = scale_.inflation * 1.01 * norm_1(v_) *
                       ((on_curve() ? 0.0 : scale_.delta) + 4.1 * unit_roundoff * farthest);
  return largest < -error || (!on_curve() && (least > error || ahead < -error));
}

template <std::size_t degree>
CurveExit Line<degree>::exit_at(double u, double spread) const {
  double along = along_[degree];
#pragma GCC unroll 8
  for (std::size_t k = 1; k <= degree; ++k) along = along_[degree - k] + u * along;
  double error = error_ + along_slope_ * spread;
  if (on_curve()) {
    const double way = u - on_;
    error = std::fabs(way) * error + spread * (std::fabs(along) + error) +
            2.1 * unit_roundoff * std::fabs(along * way);
    along *= way;
  }
  const Sign ahead = sign_within(along, error);
  return {ahead == Sign::zero ? Sign::undecided : ahead, u, along, error};
}

/// C(n, i) C(n, j) / C(2 n, i + j): the product of two polynomials of degree n in Bernstein form
/// has as its coefficient k the mean of the products of theirs with i + j = k, with these weights.
class ProductWeights {
 public:
  constexpr ProductWeights() {
    std::array<std::array<double, 2 * most + 1>, 2 * most + 1> binomial{};
    for (std::size_t n = 0; n <= 2 * most; ++n) {
      binomial[n][0] = 1.0;
      for (std::size_t k = 1; k <= n; ++k)
        binomial[n][k] = binomial[n - 1][k - 1] + (k < n ? binomial[n - 1][k] : 0.0);
    }
    for (std::size_t n = 1; n <= most; ++n)
      for (std::size_t i = 0; i <= n; ++i)
        for (std::size_t j = 0; j <= n; ++j)
          weight_[n][i][j] = binomial[n][i] * binomial[n][j] / binomial[2 * n][i + j];
  }
  constexpr double operator()(std::size_t n, std::size_t i, std::size_t j) const {
    return weight_[n][i][j];
  }

 private:
  std::array<std::array<std::array<double, most + 1>, most + 1>, most + 1> weight_{};
};
constexpr ProductWeights product_weight;

/// A Larmor circle: the side of the flight on which x(u) lies, 2 v x d + omega d.d with
/// d = x(u) - start, rises where the flight leaves. Standing on the curve d is u - on times a
/// polynomial q, whose highest power is none, and the side divided by u - on is
/// 2 v x q + omega (u - on) q.q.
template <std::size_t degree>
class LarmorCircle {
 public:
  LarmorCircle(const BezierForm& curve, Vector start, Vector v, double omega,
               const FlightScale& scale, double on);

  bool on_curve() const { return on_ >= 0.0; }
  double on() const { return on_; }
  BernsteinPolynomial<NumberWithError, 2 * most> bernstein() const;
  /// Not standing on the curve. The direction of the circle about its centre changes along it.
  Course course() const {
    const Vector along = v_ + omega_ * right(control_[0]);
    Steps steps;
    double longest = 0.0;
    for (std::size_t i = 0; i < degree; ++i) {
      const Vector step = control_[i + 1] - control_[i];
      steps.add(cross(along, step));
      longest = std::max(longest, norm_1(step));
    }
    const double turn = 1.42 * std::fabs(omega_) * curve_.reach;
    return {steps.trend(turn * longest + 6.0 * coefficient_error_), at_end(control_[0]),
            at_end(control_[degree]), coefficient_error_};
  }
  bool surely_missed() const { return false; }
  double error() const { return error_; }
  double value(double u) const {
    return side_of_flight(v_, offset(u), on_curve() ? omega_ * (u - on_) : omega_);
  }
  Local at(double u) const {
    Vector d = power_[degree], slope;
    for (std::size_t k = degree; k-- > 0;) {
      slope = d + u * slope;
      d = power_[k] + u * d;
    }
    const double turn = on_curve() ? omega_ * (u - on_) : omega_;
    return {side_of_flight(v_, d, turn), 2.0 * (cross(v_, slope) + turn * dot(d, slope)) +
                                             (on_curve() ? omega_ * dot(d, d) : 0.0)};
  }
  CurveExit exit_at(double u, double spread) const;
  static bool is_before(double kappa, double other) { return kappa > other; }

 private:
  Vector offset(double u) const {
    Vector d = power_[degree];
    for (std::size_t k = degree; k-- > 0;) d = power_[k] + u * d;
    return d;
  }
  double at_end(Vector d) const {
    const double g = cross(v_, d);
    return (g + g) + omega_ * dot(d, d);
  }

  const BezierForm& curve_;
  Vector v_;
  double omega_, on_;
  std::array<Vector, most + 1> power_, control_{};  // of d or q
  double speed_1_, off_ = 0.0;                      // |v|_1; error of a coordinate of d or q
  double offset_slope_ = 0.0;                       // bounds the derivative of a coordinate
  double error_ = 0.0, coefficient_error_ = 0.0;    // of a value; in Bernstein form
};

template <std::size_t degree>
LarmorCircle<degree>::LarmorCircle(const BezierForm& curve, Vector start, Vector v, double omega,
                                   const FlightScale& scale, double on)
    : curve_(curve), v_(v), omega_(omega), on_(on), power_(curve.power), speed_1_(norm_1(v)) {
  constexpr double u = unit_roundoff, n = degree;
  const double w = std::fabs(omega);
  if (!on_curve()) {
    for (std::size_t i = 0; i <= degree; ++i) control_[i] = curve.control[i] - start;
    power_[0] = control_[0];
    offset_slope_ = curve.speed;
  } else {
    for (std::size_t k = degree - 1; k > 0; --k) power_[k] = power_[k] + on * power_[k + 1];
    for (std::size_t k = 0; k < degree; ++k) power_[k] = power_[k + 1];
    power_[degree] = {};
    const auto share = [](Vector c, int a, int b) { return (static_cast<double>(a) / b) * c; };
    control_ = bernstein_form<most>(power_, degree - 1, share).b;
    offset_slope_ = 0.5 * n * curve.speed;
  }
  double reach = 0.0;
  for (std::size_t i = 0; i <= degree; ++i) reach = std::max(reach, norm_1(control_[i]));
  // docs/physics/exactness.md, Bézier curves: a coordinate of d and of q, coefficients, values.
  const double more = scale.inflation;
  off_ = more * (on_curve() ? (4.0 * n + 4.1) * u * curve.speed
                            : scale.delta + u * (2.1 * reach + 2.1 * n * curve.reach));
  const double side_slope = 2.01 * (speed_1_ + w * (reach + off_));
  error_ = side_slope * (off_ + more * 5.2 * u * reach);
  coefficient_error_ = side_slope * (on_curve() ? off_ + more * 13.1 * u * reach
                                                : more * (scale.delta + 9.1 * u * reach));
}

template <std::size_t degree>
BernsteinPolynomial<NumberWithError, 2 * most> LarmorCircle<degree>::bernstein() const {
  const std::size_t n = on_curve() ? degree - 1 : degree;
  std::array<double, most + 1> g;
  for (std::size_t i = 0; i <= n; ++i) g[i] = cross(v_, control_[i]);
  std::array<double, 2 * most + 1> across{}, square{};
  for (std::size_t i = 0; i <= n; ++i)
    for (std::size_t j = i; j <= n; ++j) {
      const double weight = (i == j ? 1.0 : 2.0) * product_weight(n, i, j);
      across[i + j] += weight * (g[i] + g[j]);
      square[i + j] += weight * dot(control_[i], control_[j]);
    }
  BernsteinPolynomial<NumberWithError, 2 * most> p;
  p.degree = 2 * n + (on_curve() ? 1 : 0);
  if (!on_curve()) {
    for (std::size_t k = 0; k <= p.degree; ++k)
      p.b[k] = {across[k] + omega_ * square[k], coefficient_error_};
    return p;
  }
  // Times u - on, which is -on at 0 and 1 - on at 1.
  const double all = static_cast<double>(p.degree);
  for (std::size_t k = 0; k <= p.degree; ++k) {
    double sum = 0.0;
    if (k < p.degree)
      sum = (all - static_cast<double>(k)) / all * (across[k] - omega_ * on_ * square[k]);
    if (k > 0)
      sum += static_cast<double>(k) / all * (across[k - 1] + omega_ * (1.0 - on_) * square[k - 1]);
    p.b[k] = {sum, coefficient_error_};
  }
  return p;
}

template <std::size_t degree>
CurveExit LarmorCircle<degree>::exit_at(double u, double spread) const {
  const Vector d = offset(u);
  const double size = norm_1(d), off = off_ + offset_slope_ * spread;
  const double along = dot(v_, d), along_error = speed_1_ * (off + 2.1 * unit_roundoff * size);
  double square = dot(d, d);
  double square_error = 2.01 * off * (size + off) + 2.1 * unit_roundoff * size * size;
  if (on_curve()) {
    const double way = u - on_;
    square_error = std::fabs(way) * square_error +
                   (spread + 2.1 * unit_roundoff * std::fabs(way)) * (square + square_error);
    square *= way;
  }
  // kappa = v.d / d.d; where d may vanish it passes through infinity.
  const double least = std::fabs(square) - square_error;
  if (!(least > 0.0)) return {};
  const double kappa = along / square;
  return {Sign::positive, u, kappa,
          (along_error + std::fabs(kappa) * square_error) / least +
              1.1 * unit_roundoff * std::fabs(kappa)};
}

/// Calls `found` with the curve's degree, known to the compiler.
CurveExit with_degree(const BezierForm& curve, const auto& found) {
  switch (curve.degree) {
    case 2:
      return found(std::integral_constant<std::size_t, 2>());
    case 3:
      return found(std::integral_constant<std::size_t, 3>());
    case 4:
      return found(std::integral_constant<std::size_t, 4>());
    default:
      return found(std::integral_constant<std::size_t, 5>());
  }
}

}  // namespace

CurveExit first_exit(const BezierForm& curve, Vector start, Vector velocity,
                     const FlightScale& scale, double on) {
  return with_degree(
      curve, [&](auto n) { return first_exit_of(Line<n()>(curve, start, velocity, scale, on)); });
}

CurveExit first_exit(const BezierForm& curve, Vector start, Vector velocity, double omega,
                     const FlightScale& scale, double on) {
  return with_degree(curve, [&](auto n) {
    return first_exit_of(LarmorCircle<n()>(curve, start, velocity, omega, scale, on));
  });
}

}  // namespace carom::geometry
