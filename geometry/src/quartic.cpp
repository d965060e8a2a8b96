#include "carom/geometry/quartic.hpp"

#include <cmath>

#include "carom/geometry/bernstein.hpp"
#include "carom/geometry/first_root.hpp"
#include "number_with_error.hpp"

namespace carom::geometry {

namespace {

constexpr double u = unit_roundoff;

using Polynomial = BernsteinPolynomial<NumberWithError>;

/// De Casteljau.
NumberWithError value_at(Polynomial p, double t) {
  auto& b = p.b;
  for (std::size_t k = p.degree; k > 0; --k)
    for (std::size_t i = 0; i < k; ++i) {
      // 1 - t is rounded once, two products, one sum.
      const double x = (1.0 - t) * b[i].value, y = t * b[i + 1].value;
      b[i].error = (1.0 - t) * b[i].error + t * b[i + 1].error +
                   3.1 * u * (std::fabs(x) + std::fabs(y)) +
                   3.1 * u * (b[i].error + b[i + 1].error);
      b[i].value = x + y;
    }
  return b[0];
}
double slope_at(const Polynomial& p, double t) {
  // In Bernstein form, too: degree (b[i+1] - b[i]).
  double d[4];
  for (std::size_t k = 0; k < p.degree; ++k)
    d[k] = static_cast<double>(p.degree) * (p.b[k + 1].value - p.b[k].value);
  for (std::size_t k = p.degree - 1; k > 0; --k)
    for (std::size_t j = 0; j < k; ++j) d[j] += t * (d[j + 1] - d[j]);
  return d[0];
}

/// The one root of p in (0, 1), at whose ends p has opposite certain signs: t and an interval about
/// it.
bool refine(const Polynomial& p, double& t, double& low, double& high) {
  double l = 0.0, h = 1.0;
  const double first = p.b[0].value;
  const bool rises = first < 0.0;
  t = first / (first - p.b[p.degree].value);
  // Newton, guarded by the bracket. What is less than its error is still nearly right: one step
  // more.
  double last = 1.0;
  bool closing = false;
  for (int i = 0; i < 100 && !closing; ++i) {
    const NumberWithError f = value_at(p, t);
    closing = std::fabs(f.value) <= f.error;
    if (!closing) ((f.value < 0.0) == rises ? l : h) = t;
    double next = t - f.value / slope_at(p, t);
    if (!(next > l && next < h)) {
      if (closing) break;
      next = 0.5 * (l + h);
    }
    const double step = std::fabs(next - t);
    t = next;
    if (step == 0.0 || (i > 60 && step >= last)) break;
    last = step;
  }
  // Walk outwards until the signs are certain: then the interval holds the root.
  double width = 2.0 * value_at(p, t).error / std::fabs(slope_at(p, t)) + 2.0 * u;
  if (!(width < 1.0)) return false;
  const Sign before = rises ? Sign::negative : Sign::positive;
  for (int tries = 0; tries < 60 && width < 1.0; ++tries, width *= 4.0) {
    low = t - width > 0.0 ? t - width : 0.0;
    high = t + width < 1.0 ? t + width : 1.0;
    if (value_at(p, low).sign() == before && value_at(p, high).sign() == -before) return true;
  }
  return false;
}

/// One of the four parts of the line: kappa = to_kappa(t) on t in [0, 1].
struct Part {
  bool outer;  // kappa = sigma K / t, else sigma K t
  double sigma;
  double scale;
  double passed;  // roots below this t are not asked for
  double kappa(double t) const { return outer ? sigma * (scale / t) : sigma * (scale * t); }
};

constexpr int deepest = 40;

/// Reports a root of p, which is the polynomial between `from` and `to` of the part. False:
/// undecided; nothing: p must be halved.
std::optional<bool> look(const Polynomial& p, double from, double to, int depth, const Part& part,
                         RisingRoots& out, int most) {
  if (out.count >= most || to <= part.passed) return true;
  const SignChanges roots = sign_changes(p, [](const NumberWithError& x) { return x.sign(); });
  // The sign at an end below `passed` need not be certain: bisection cuts that part off.
  const bool open = roots.first == Sign::undecided, cut = open && from < part.passed;
  if ((open && !cut) || roots.last == Sign::undecided) return false;
  if (roots.most == 0 && !cut) return true;
  if (roots.least == 1 && roots.most == 1 && !cut) {
    const bool rises_with_t = roots.first == Sign::negative;
    const bool kappa_grows = (part.sigma > 0) != part.outer;
    if (rises_with_t != kappa_grows) return true;  // falls along kappa
    double t = 0, l = 0, h = 0;
    if (!refine(p, t, l, h)) return false;
    const double width = to - from;
    const double k = part.kappa(from + width * t);
    const double k1 = part.kappa(from + width * l), k2 = part.kappa(from + width * h);
    CertifiedRoot& r = out.roots[out.count++];
    r.kappa = k;
    r.error =
        std::fmax(std::fabs(k1 - k), std::fabs(k2 - k)) + 6.1 * u * (std::fabs(k1) + std::fabs(k2));
    return true;
  }
  if (depth == deepest) return false;
  return std::nullopt;
}

RisingRoots isolated_roots(const Quartic<double>& f, const QuarticError& error, int degree,
                           double scale, int most, double farthest) {
  RisingRoots out;
  // kappa = K x: coefficients and errors of the polynomial in x.
  std::array<NumberWithError, 5> c;
  double power = 1.0;
  const auto size = static_cast<std::size_t>(degree);
  for (std::size_t i = 0; i <= size; ++i) {
    c[i].value = f.q[i] * power;
    c[i].error = 1.01 * error.q[i] * power + 5.1 * u * std::fabs(c[i].value);
    power *= scale;
  }
  for (int n = 0; n < 4 && out.count < most; ++n) {
    Part part{
        .outer = n == 0 || n == 3, .sigma = n < 2 ? 1.0 : -1.0, .scale = scale, .passed = 0.0};
    std::array<NumberWithError, 5> m;
    for (std::size_t i = 0; i <= size; ++i) {
      const std::size_t k = part.outer ? size - i : i;  // t = 1/x reverses the coefficients
      m[i] = c[k];
      if (part.sigma < 0 && k % 2 == 1) m[i].value = -m[i].value;
    }
    const Polynomial p = bernstein_form(m, size, share_of);
    if (part.outer && p.b[0].sign() == Sign::undecided) part.passed = scale / farthest;
    // Falling kappa: t grows in [K, inf) and in [-K, 0], falls in the others.
    const bool ascending = n == 0 || n == 2;
    out.decided = isolate(p, 0.0, 1.0, ascending, 0,
                          [&](const Polynomial& piece, double from, double to, int depth) {
                            return look(piece, from, to, depth, part, out, most);
                          });
    if (!out.decided) return out;
  }
  return out;
}

/// A polynomial's value, first and half second derivative at x, with bounds of their errors.
struct Taylor {
  double value = 0.0, first = 0.0, second = 0.0;
  double value_error = 0.0, first_error = 0.0, second_error = 0.0;
};
Taylor cubic_at(const Quartic<double>& f, const QuarticError& error, double x) {
  Taylor t;
  double v = 0.0, d = 0.0,
         s = 0.0;  // the same of the coefficients' errors, those of 3 roundings a step included
  const double size = std::fabs(x);
  for (int i = 3; i >= 0; --i) {
    t.second = t.second * x + t.first;
    t.first = t.first * x + t.value;
    t.value = t.value * x + f.q[i];
    s = s * size + d;
    d = d * size + v;
    v = v * size + (error.q[i] + 20.0 * u * std::fabs(f.q[i]));
  }
  t.value_error = 1.01 * v;
  t.first_error = 1.01 * d;
  t.second_error = 1.01 * s;
  return t;
}

/// Is x certain to be the largest root of a cubic? It is if f < 0 closely below, and closely above
/// f > 0, f' > 0, and f' + f'' s/2 + q3 s^2, by which it grows from there, has no root s > 0.
bool is_largest(const Quartic<double>& f, const QuarticError& error, double x,
                CertifiedRoot& root) {
  const Taylor at = cubic_at(f, error, x);
  const double width =
      2.0 * (std::fabs(at.value) + at.value_error) / at.first + 8.0 * u * std::fabs(x);
  if (!(at.first > at.first_error) || !(width < HUGE_VAL)) return false;
  const Taylor below = cubic_at(f, error, x - width), above = cubic_at(f, error, x + width);
  const double lead = f.q[3] - error.q[3], rise = above.first - above.first_error;
  if (!(below.value < -below.value_error && above.value > above.value_error && rise > 0.0 &&
        lead > 0.0))
    return false;
  const double bend = above.second_error - above.second;  // bounds how far it bends down
  if (!(bend < 0.0) && !(bend * bend < 3.99 * lead * rise)) return false;
  root = {x, 1.01 * width};
  return true;
}

}  // namespace

double likely_root(const Quartic<double>& f, int degree) {
  return degree == 3 ? largest_root(f.q[3], f.q[2], f.q[1], f.q[0], RoughCubeRoot{})
                     : first_rising_root(f, RoughCubeRoot{});
}

RisingRoots rising_roots(const Quartic<double>& f, const QuarticError& error, int degree,
                         double scale, int most, double farthest) {
  const double likely = likely_root(f, f.q[4] == 0.0 ? 3 : degree);
  RisingRoots out;
  if (degree == 3 && most == 1 && is_largest(f, error, likely, out.roots[0])) {
    out.count = 1;
    return out;
  }
  out = isolated_roots(f, error, degree, scale, most, farthest);
  // Where errors are large several roots may lie about the likely one: the nearest is meant. It may
  // be replaced at any distance, which is added to its error: 2^24 errors only keep that small.
  const auto away = [&](int i) { return std::fabs(likely - out.roots[i].kappa); };
  int nearest = 0;
  for (int i = 1; i < out.count; ++i)
    if (away(i) < away(nearest)) nearest = i;
  if (out.count > 0 && away(nearest) <= 0x1p24 * out.roots[nearest].error) {
    out.roots[nearest].error += away(nearest);
    out.roots[nearest].kappa = likely;
  }
  return out;
}

QuarticError quartic_error(const FlightScale& f, double e1, double centre_error, double row,
                           bool on_wall) {
  const double eta = row * (f.delta + centre_error + 7.1 * u * e1);
  const double m = 2.01 * row * e1, n1 = 2.01 * row * f.speed_1;
  const double nu = 6.1 * u * row * f.speed_1;
  const double h_size = on_wall ? 0.0 : m * m + 1.0;
  const double h = on_wall ? 0.0 : 2.01 * m * eta + 2.01 * eta * eta + 3.1 * u * h_size;
  const double ev = m * nu + n1 * eta + 2.01 * nu * eta + 2.1 * u * m * n1;
  const double vv = 2.01 * n1 * nu + 2.01 * nu * nu + 2.1 * u * n1 * n1;
  const double n = 0.2501 * f.omega * f.omega;
  const double me = m * n1, mv = n1 * n1;
  const double constant =
      n * (h + 5.1 * u * h_size) + f.omega * (ev + 3.1 * u * me) + vv + 3.1 * u * mv;
  QuarticError q;
  q.q[4] = h;
  q.q[3] = 2.0 * ev;
  q.q[2] = 2.0 * n * (h + 5.1 * u * h_size) + f.omega * (ev + 4.1 * u * me) + vv + 3.1 * u * mv;
  q.q[1] = 2.0 * n * (ev + 5.1 * u * me) + f.omega * (vv + 4.1 * u * mv);
  q.q[0] = n * (constant + 4.1 * u * (n * h_size + f.omega * me + mv));
  for (double& x : q.q) x *= f.inflation;
  return q;
}

}  // namespace carom::geometry
