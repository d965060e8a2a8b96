#include "carom/geometry/bezier_flight.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "carom/geometry/bernstein.hpp"
#include "number_with_error.hpp"

namespace carom::geometry {

namespace {

constexpr std::size_t most = Bezier::most;
constexpr int deepest = 40;
using Powers = std::array<double, most + 1>;

double norm_1(Vector v) { return std::fabs(v.x) + std::fabs(v.y); }

/// A polynomial in u and its derivative.
struct Local {
  double value, slope;
};

/// The line as polynomials in u: g = v x (x(u) - start), which rises where the line leaves the
/// domain, and a = v . (x(u) - start). Standing on the curve both are divided by u - on.
class Line {
 public:
  Line(const BezierForm& curve, Vector start, Vector v, const FlightScale& scale, double on);

  bool stands() const { return on_ >= 0.0; }
  double on() const { return on_; }
  const BernsteinPolynomial<NumberWithError, most>& bernstein() const { return bernstein_; }
  double error() const { return error_; }
  double value(double u) const { return value(across_, u); }
  double slope(double u) const {
    double sum = 0.0;
    for (std::size_t k = degree_; k > 0; --k) sum = static_cast<double>(k) * across_[k] + u * sum;
    return sum;
  }
  Local at(double u) const { return {value(u), slope(u)}; }
  /// The exit at a root that u misses by at most `spread`: none if it lies behind.
  CurveExit exit_at(double u, double spread) const;
  static bool is_before(double place, double other) { return place < other; }

 private:
  double value(const Powers& p, double u) const {
    double sum = p[degree_];
    for (std::size_t k = degree_; k-- > 0;) sum = p[k] + u * sum;
    return sum;
  }

  double on_;
  std::size_t degree_;
  Powers across_{}, along_{};
  double error_ = 0.0;        // of a value of both
  double along_slope_ = 0.0;  // bounds that of a
  BernsteinPolynomial<NumberWithError, most> bernstein_;
};

Line::Line(const BezierForm& curve, Vector start, Vector v, const FlightScale& scale, double on)
    : on_(on), degree_(curve.degree) {
  constexpr double u = unit_roundoff;
  const double n = static_cast<double>(degree_), size = norm_1(v) * curve.reach;
  for (std::size_t k = 1; k <= degree_; ++k) {
    across_[k] = cross(v, curve.power[k]);
    along_[k] = dot(v, curve.power[k]);
  }
  if (!stands()) {
    for (std::size_t i = 0; i <= degree_; ++i) {
      const Vector d = curve.control[i] - start;
      bernstein_.b[i] = {cross(v, d),
                         scale.inflation * 1.01 * norm_1(v) * (scale.delta + 4.1 * u * norm_1(d))};
    }
    across_[0] = bernstein_.b[0].value;
    along_[0] = dot(v, curve.control[0] - start);
    // A coefficient errs by 3u of |v|_1 |power|, Horner's rule by 2u a step.
    error_ = bernstein_.b[0].error + scale.inflation * (2.0 * n + 4.1) * u * size;
    along_slope_ = norm_1(v) * curve.speed;
  } else {
    // Coefficient j is the sum of power[k] on^(k - 1 - j) over k > j: with 2u a step and what the
    // powers err by (2 n + 3)u; all of them together sum at most n |v|_1 reach.
    for (Powers* p : {&across_, &along_}) {
      for (std::size_t k = degree_ - 1; k > 0; --k) (*p)[k] += on * (*p)[k + 1];
      for (std::size_t k = 0; k < degree_; ++k) (*p)[k] = (*p)[k + 1];
      (*p)[degree_] = 0.0;
    }
    --degree_;
    std::array<NumberWithError, most + 1> c;
    for (std::size_t k = 0; k <= degree_; ++k)
      c[k] = {across_[k], scale.inflation * (2.0 * n + 3.1) * u * size};
    bernstein_ = bernstein_form<most>(c, degree_, share_of);
    for (std::size_t k = 0; k <= degree_; ++k)
      bernstein_.b[k].error +=
          scale.inflation * 7.1 * u * n * size;  // roundings count whatever the inflation is
    error_ = scale.inflation * (4.0 * n + 4.1) * u * n * size;
    along_slope_ = n * n * size;
  }
  bernstein_.degree = degree_;
}

/// Most curves that are asked are missed or lie behind, and most of those that flights begin on are
/// left for good: by signs alone.
bool surely_missed(const BezierForm& curve, Vector start, Vector v, const FlightScale& scale,
                   double on) {
  constexpr double u = unit_roundoff;
  const bool stands = on >= 0.0;
  double least = HUGE_VAL, largest = -HUGE_VAL, ahead = -HUGE_VAL, farthest = 0.0;
  // Standing on the curve g / (u - on) = v x (a mean of x'), and x' lies in the hull of the
  // differences of control points; there it is negative.
  for (std::size_t i = stands ? 1 : 0; i <= curve.degree; ++i) {
    const Vector d = curve.control[i] - (stands ? curve.control[i - 1] : start);
    const double g = cross(v, d);
    least = std::min(least, g);
    largest = std::max(largest, g);
    ahead = std::max(ahead, dot(v, d));
    farthest = std::max(farthest, norm_1(d));
  }
  const double error =
      scale.inflation * 1.01 * norm_1(v) * ((stands ? 0.0 : scale.delta) + 4.1 * u * farthest);
  return largest < -error || (!stands && (least > error || ahead < -error));
}

CurveExit Line::exit_at(double u, double spread) const {
  double along = value(along_, u);
  double error = error_ + along_slope_ * spread;
  if (stands()) {
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
/// polynomial q, and the side divided by u - on is 2 v x q + omega (u - on) q.q.
class LarmorCircle {
 public:
  LarmorCircle(const BezierForm& curve, Vector start, Vector v, double omega,
               const FlightScale& scale, double on);

  bool stands() const { return on_ >= 0.0; }
  double on() const { return on_; }
  const BernsteinPolynomial<NumberWithError, 2 * most>& bernstein() const { return bernstein_; }
  double error() const { return error_; }
  double value(double u) const {
    return side_of_flight(v_, offset(u), stands() ? omega_ * (u - on_) : omega_);
  }
  Local at(double u) const {
    Vector d = power_[degree_], slope;
    for (std::size_t k = degree_; k-- > 0;) {
      slope = d + u * slope;
      d = power_[k] + u * d;
    }
    const double turn = stands() ? omega_ * (u - on_) : omega_;
    return {side_of_flight(v_, d, turn), 2.0 * (cross(v_, slope) + turn * dot(d, slope)) +
                                             (stands() ? omega_ * dot(d, d) : 0.0)};
  }
  CurveExit exit_at(double u, double spread) const;
  static bool is_before(double kappa, double other) { return kappa > other; }

 private:
  Vector offset(double u) const {
    Vector d = power_[degree_];
    for (std::size_t k = degree_; k-- > 0;) d = power_[k] + u * d;
    return d;
  }

  Vector v_;
  double omega_, on_;
  std::size_t degree_;                    // of d or q
  std::array<Vector, most + 1> power_{};  // of d or q
  double speed_1_, off_ = 0.0;            // |v|_1; error of a coordinate of d or q
  double offset_slope_ = 0.0;             // bounds the derivative of a coordinate
  double error_ = 0.0;                    // of a value
  BernsteinPolynomial<NumberWithError, 2 * most> bernstein_;
};

LarmorCircle::LarmorCircle(const BezierForm& curve, Vector start, Vector v, double omega,
                           const FlightScale& scale, double on)
    : v_(v), omega_(omega), on_(on), degree_(curve.degree), speed_1_(norm_1(v)) {
  constexpr double u = unit_roundoff;
  const double n = static_cast<double>(degree_), w = std::fabs(omega);
  std::array<Vector, most + 1> control;  // of d or q
  power_ = curve.power;
  if (!stands()) {
    for (std::size_t i = 0; i <= degree_; ++i) control[i] = curve.control[i] - start;
    power_[0] = control[0];
    offset_slope_ = curve.speed;
  } else {
    for (std::size_t k = degree_ - 1; k > 0; --k) power_[k] = power_[k] + on * power_[k + 1];
    for (std::size_t k = 0; k < degree_; ++k) power_[k] = power_[k + 1];
    power_[degree_--] = {};
    const auto share = [](Vector c, int a, int b) { return (static_cast<double>(a) / b) * c; };
    control = bernstein_form<most>(power_, degree_, share).b;
    offset_slope_ = 0.5 * n * curve.speed;
  }
  double reach = 0.0;
  for (std::size_t i = 0; i <= degree_; ++i) reach = std::max(reach, norm_1(control[i]));
  // docs/physics/exactness.md, Bézier curves: a coordinate of d and of q, coefficients, values.
  const double more = scale.inflation;
  off_ = more * (stands() ? (4.0 * n + 4.1) * u * curve.speed
                          : scale.delta + u * (2.1 * reach + 2.1 * n * curve.reach));
  const double side_slope = 2.01 * (speed_1_ + w * (reach + off_));
  error_ = side_slope * (off_ + more * 5.2 * u * reach);
  const double error = side_slope * (stands() ? off_ + more * 13.1 * u * reach
                                              : more * (scale.delta + 9.1 * u * reach));

  std::array<double, most + 1> g;
  for (std::size_t i = 0; i <= degree_; ++i) g[i] = cross(v, control[i]);
  std::array<double, 2 * most + 1> across{}, square{};
  for (std::size_t i = 0; i <= degree_; ++i)
    for (std::size_t j = i; j <= degree_; ++j) {
      const double weight = (i == j ? 1.0 : 2.0) * product_weight(degree_, i, j);
      across[i + j] += weight * (g[i] + g[j]);
      square[i + j] += weight * dot(control[i], control[j]);
    }
  bernstein_.degree = 2 * degree_ + (stands() ? 1 : 0);
  if (!stands()) {
    for (std::size_t k = 0; k <= bernstein_.degree; ++k)
      bernstein_.b[k] = {across[k] + omega * square[k], error};
  } else {
    // Times u - on, which is -on at 0 and 1 - on at 1.
    const double all = static_cast<double>(bernstein_.degree);
    for (std::size_t k = 0; k <= bernstein_.degree; ++k) {
      double sum = 0.0;
      if (k < bernstein_.degree)
        sum = (all - static_cast<double>(k)) / all * (across[k] - omega * on * square[k]);
      if (k > 0)
        sum += static_cast<double>(k) / all * (across[k - 1] + omega * (1.0 - on) * square[k - 1]);
      bernstein_.b[k] = {sum, error};
    }
  }
}

CurveExit LarmorCircle::exit_at(double u, double spread) const {
  const Vector d = offset(u);
  const double size = norm_1(d), off = off_ + offset_slope_ * spread;
  const double along = dot(v_, d), along_error = speed_1_ * (off + 2.1 * unit_roundoff * size);
  double square = dot(d, d);
  double square_error = 2.01 * off * (size + off) + 2.1 * unit_roundoff * size * size;
  if (stands()) {
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

/// Isolates the roots of a flight's side and keeps the first exit.
template <class Path>
class Search {
 public:
  explicit Search(const Path& path) : path_(path) {}

  CurveExit first() {
    found_.leaves = Sign::negative;
    const bool decided = isolate(path_.bernstein(), 0.0, 1.0, true, 0,
                                 [this](const auto& p, double from, double to, int depth) {
                                   return this->look(p, from, to, depth);
                                 });
    if (!decided) found_.leaves = Sign::undecided;
    return found_;
  }

 private:
  template <class Polynomial>
  std::optional<bool> look(const Polynomial& p, double from, double to, int depth) {
    const SignChanges roots = sign_changes(p, [](const NumberWithError& x) { return x.sign(); });
    if (roots.first == Sign::undecided || roots.last == Sign::undecided) return false;
    if (roots.most == 0) return true;
    if (roots.least == 1 && roots.most == 1) {
      const bool rises = roots.first == Sign::negative;
      if (!rises && !path_.stands()) return true;
      return add(p.b[0].value, p.b[p.degree].value, from, to, rises);
    }
    if (depth == deepest) return false;
    return std::nullopt;
  }
  bool add(double first, double last, double from, double to, bool rises);

  const Path& path_;
  CurveExit found_;
};

/// The one root in [from, to], where the sign changes between the values `first` and `last`, if the
/// flight leaves there.
template <class Path>
bool Search<Path>::add(double first, double last, double from, double to, bool rises) {
  double low = from, high = to;
  double u = from + (to - from) * (first / (first - last));
  for (int i = 0; i < 100; ++i) {
    const Local here = path_.at(u);
    if (here.value == 0.0) break;
    ((here.value < 0.0) == rises ? low : high) = u;
    double next = u - here.value / here.slope;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    const double step = std::fabs(next - u);
    u = next;
    if (step <= 0x1p-52 * u) break;  // wherever it stops: signs about it decide below
  }
  // Outwards until the signs are certain: then the root is between.
  const double error = path_.error(), before = rises ? -1.0 : 1.0;
  double width = 2.0 * error / std::fabs(path_.at(u).slope) + 4.0 * unit_roundoff;
  for (;; width *= 4.0) {
    low = std::fmax(from, u - width);
    high = std::fmin(to, u + width);
    const bool starts = low == from || before * path_.value(low) > error,
               ends = high == to || -before * path_.value(high) > error;
    if (starts && ends) break;
    if (!(width < 1.0)) return false;
  }
  // Along a wall that is grazed the place is hidden by rounding: the exact stage gives it. Both
  // stages decide by signs that are certain, so that the bound chooses the stage alone:
  // with it u is off by 2^-24 of the piece at most.
  const double spread = std::fmax(u - low, high - u);
  if (spread > 0x1p-24) return false;
  if (path_.stands()) {
    // Beyond the start a root is left through where the quotient by u - on rises, before it where
    // that falls.
    if (low <= path_.on() && high >= path_.on()) return false;
    if (rises != (u > path_.on())) return true;
  }
  const CurveExit exit = path_.exit_at(u, spread);
  if (exit.leaves != Sign::positive) return exit.leaves == Sign::negative;
  if (found_.leaves == Sign::positive) {
    if (!(std::fabs(exit.place - found_.place) > exit.error + found_.error)) return false;
    if (Path::is_before(found_.place, exit.place)) return true;
  }
  found_ = exit;
  return true;
}

}  // namespace

CurveExit first_exit(const BezierForm& curve, Vector start, Vector velocity,
                     const FlightScale& scale, double on) {
  if (surely_missed(curve, start, velocity, scale, on)) return {.leaves = Sign::negative};
  return Search(Line(curve, start, velocity, scale, on)).first();
}

CurveExit first_exit(const BezierForm& curve, Vector start, Vector velocity, double omega,
                     const FlightScale& scale, double on) {
  return Search(LarmorCircle(curve, start, velocity, omega, scale, on)).first();
}

}  // namespace carom::geometry
