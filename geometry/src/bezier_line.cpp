#include "carom/geometry/bezier_line.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "carom/geometry/bernstein.hpp"
#include "number_with_error.hpp"

namespace carom::geometry {

namespace {

constexpr std::size_t most = Bezier::most;
constexpr int deepest = 40;
using Polynomial = BernsteinPolynomial<NumberWithError, most>;
using Powers = std::array<double, most + 1>;

double norm_1(Vector v) { return std::fabs(v.x) + std::fabs(v.y); }

/// The line as polynomials in u: g = v x (x(u) - start), which rises where the line leaves the
/// domain, and a = v . (x(u) - start). Standing on the curve both are divided by u - on.
class Line {
 public:
  Line(const BezierForm& curve, Vector start, Vector v, const FlightScale& scale, double on);

  LineExit first();

 private:
  double value(const Powers& p, double u) const {
    double sum = p[degree_];
    for (std::size_t k = degree_; k-- > 0;) sum = p[k] + u * sum;
    return sum;
  }
  double slope(const Powers& p, double u) const {
    double sum = 0.0;
    for (std::size_t k = degree_; k > 0; --k) sum = static_cast<double>(k) * p[k] + u * sum;
    return sum;
  }
  bool stands() const { return on_ >= 0.0; }
  std::optional<bool> look(const Polynomial& p, double from, double to, int depth);
  bool add(const Polynomial& p, double from, double to, bool rises);

  double on_;
  std::size_t degree_;
  Powers across_{}, along_{};
  double error_ = 0.0;        // of a value of both
  double along_slope_ = 0.0;  // bounds that of a
  Polynomial bernstein_;
  LineExit found_;
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

/// The one root of g in [from, to], where its sign changes, if the line leaves there.
bool Line::add(const Polynomial& p, double from, double to, bool rises) {
  double low = from, high = to;
  const double first = p.b[0].value, last = p.b[p.degree].value;
  double u = from + (to - from) * (first / (first - last));
  for (int i = 0; i < 100; ++i) {
    const double g = value(across_, u);
    if (g == 0.0) break;
    ((g < 0.0) == rises ? low : high) = u;
    double next = u - g / slope(across_, u);
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    const double step = std::fabs(next - u);
    u = next;
    if (step <= 0x1p-52 * u) break;  // wherever it stops: signs about it decide below
  }
  // Outwards until the signs are certain: then the root is between.
  double width = 2.0 * error_ / std::fabs(slope(across_, u)) + 4.0 * unit_roundoff;
  const double before = rises ? -1.0 : 1.0;
  for (;; width *= 4.0) {
    low = std::fmax(from, u - width);
    high = std::fmin(to, u + width);
    const bool starts = low == from || before * value(across_, low) > error_,
               ends = high == to || -before * value(across_, high) > error_;
    if (starts && ends) break;
    if (!(width < 1.0)) return false;
  }
  // Along a wall that is grazed the place is hidden by rounding: the exact stage gives it. Both
  // stages decide by signs that are certain, so that the bound chooses the stage alone:
  // with it u is off by 2^-24 of the piece at most.
  const double spread = std::fmax(u - low, high - u);
  if (spread > 0x1p-24) return false;
  double along = value(along_, u);
  double error = error_ + along_slope_ * spread;
  if (stands()) {
    // Beyond the start a root is left through where g / (u - on) rises, before it where that falls.
    if (low <= on_ && high >= on_) return false;
    if (rises != (u > on_)) return true;
    const double way = u - on_;
    error = std::fabs(way) * error + spread * (std::fabs(along) + error) +
            2.1 * unit_roundoff * std::fabs(along * way);
    along *= way;
  }
  if (along < -error) return true;
  if (!(along > error)) return false;
  if (found_.leaves == Sign::positive) {
    if (!(std::fabs(along - found_.along) > error + found_.error)) return false;
    if (along > found_.along) return true;
  }
  found_ = {Sign::positive, u, along, error};
  return true;
}

std::optional<bool> Line::look(const Polynomial& p, double from, double to, int depth) {
  const SignChanges roots = sign_changes(p, [](const NumberWithError& x) { return x.sign(); });
  if (roots.first == Sign::undecided || roots.last == Sign::undecided) return false;
  if (roots.most == 0) return true;
  if (roots.least == 1 && roots.most == 1) {
    const bool rises = roots.first == Sign::negative;
    if (!rises && !stands()) return true;
    return add(p, from, to, rises);
  }
  if (depth == deepest) return false;
  return std::nullopt;
}

LineExit Line::first() {
  found_.leaves = Sign::negative;
  const bool decided = isolate(bernstein_, 0.0, 1.0, true, 0,
                               [this](const Polynomial& p, double from, double to, int depth) {
                                 return look(p, from, to, depth);
                               });
  if (!decided) found_.leaves = Sign::undecided;
  return found_;
}

}  // namespace

LineExit first_exit(const BezierForm& curve, Vector start, Vector velocity,
                    const FlightScale& scale, double on) {
  if (surely_missed(curve, start, velocity, scale, on)) return {.leaves = Sign::negative};
  return Line(curve, start, velocity, scale, on).first();
}

}  // namespace carom::geometry
