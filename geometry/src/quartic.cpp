#include "carom/geometry/quartic.hpp"

#include <cmath>

#include "carom/geometry/first_root.hpp"

namespace carom::geometry {

namespace {

constexpr double u = unit_roundoff;

/// A polynomial on [0, 1] in Bernstein form, each coefficient with a bound on its error.
struct Bernstein {
  double b[5];
  double e[5];
};

constexpr double binomial[5][5] = {
    {1, 0, 0, 0, 0}, {1, 1, 0, 0, 0}, {1, 2, 1, 0, 0}, {1, 3, 3, 1, 0}, {1, 4, 6, 4, 1}};

Bernstein bernstein(const double* c, const double* error, int degree) {
  Bernstein p;
  for (int i = 0; i <= degree; ++i) {
    p.b[i] = 0.0;
    p.e[i] = 0.0;
    for (int j = 0; j <= i; ++j) {
      // The quotient of binomials is rounded once, the product once, each partial sum once.
      const double term = binomial[i][j] / binomial[degree][j] * c[j];
      p.b[i] += term;
      p.e[i] += binomial[i][j] / binomial[degree][j] * 1.01 * error[j] + 7.1 * u * std::fabs(term);
    }
  }
  return p;
}

/// -1, 0, +1, or 2 where the error hides the sign.
int sign_of(double b, double e) { return b > e ? 1 : b < -e ? -1 : 2; }

/// Value and error at t, de Casteljau.
double value_at(const Bernstein& p, int degree, double t, double& error) {
  double b[5], e[5];
  for (int i = 0; i <= degree; ++i) {
    b[i] = p.b[i];
    e[i] = p.e[i];
  }
  for (int k = degree; k > 0; --k)
    for (int i = 0; i < k; ++i) {
      // 1 - t is rounded once, two products, one sum.
      const double x = (1.0 - t) * b[i], y = t * b[i + 1];
      e[i] = (1.0 - t) * e[i] + t * e[i + 1] + 3.1 * u * (std::fabs(x) + std::fabs(y)) +
             3.1 * u * (e[i] + e[i + 1]);
      b[i] = x + y;
    }
  error = e[0];
  return b[0];
}

/// The one root of p in (0, 1), at whose ends p has opposite certain signs: t and an interval about
/// it.
bool refine(const Bernstein& p, int degree, double& t, double& low, double& high) {
  double l = 0.0, h = 1.0, error = 0.0;
  const bool rises = p.b[0] < 0.0;
  t = p.b[0] / (p.b[0] - p.b[degree]);
  // Newton, guarded by the bracket. What is less than its error is still nearly right: one step
  // more.
  double last = 1.0;
  bool closing = false;
  for (int i = 0; i < 100 && !closing; ++i) {
    const double f = value_at(p, degree, t, error);
    closing = std::fabs(f) <= error;
    if (!closing) ((f < 0.0) == rises ? l : h) = t;
    // Derivative in Bernstein form: degree (b[i+1] - b[i]).
    double d[4];
    for (int k = 0; k < degree; ++k) d[k] = degree * (p.b[k + 1] - p.b[k]);
    for (int k = degree - 1; k > 0; --k)
      for (int j = 0; j < k; ++j) d[j] += t * (d[j + 1] - d[j]);
    double next = t - f / d[0];
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
  value_at(p, degree, t, error);
  double d[4];
  for (int k = 0; k < degree; ++k) d[k] = degree * (p.b[k + 1] - p.b[k]);
  for (int k = degree - 1; k > 0; --k)
    for (int j = 0; j < k; ++j) d[j] += t * (d[j + 1] - d[j]);
  double width = 2.0 * error / std::fabs(d[0]) + 2.0 * u;
  if (!(width < 1.0)) return false;
  for (int tries = 0; tries < 60 && width < 1.0; ++tries, width *= 4.0) {
    low = t - width > 0.0 ? t - width : 0.0;
    high = t + width < 1.0 ? t + width : 1.0;
    double low_error = 0.0, high_error = 0.0;
    const double at_low = value_at(p, degree, low, low_error);
    const double at_high = value_at(p, degree, high, high_error);
    const int a = sign_of(at_low, low_error), b = sign_of(at_high, high_error);
    if (a != 2 && b != 2 && a == -b && (a < 0) == rises) return true;
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

/// Reports the roots of p on (0, 1) mapped to [from, to] of the part, in the order of falling
/// kappa.
bool isolate(const Bernstein& p, int degree, double from, double to, const Part& part,
             bool ascending, int depth, RisingRoots& out, int most) {
  if (out.count >= most || to <= part.passed) return true;
  // The sign at an end below `passed` need not be certain: bisection cuts that part off.
  const bool cut = from < part.passed && sign_of(p.b[0], p.e[0]) == 2;
  int low = 0, high = 0, last = 2;
  bool open = false;
  for (int i = 0; i <= degree; ++i) {
    const int s = sign_of(p.b[i], p.e[i]);
    if (s == 2) {
      if ((i == 0 && !cut) || i == degree) return false;
      open = true;
      continue;
    }
    if (last != 2 && s != last) ++low;
    last = s;
  }
  high = open ? degree : low;
  if (!open && low == 0) return true;
  // An uncertain coefficient between two certain neighbours of opposite sign changes nothing.
  if (open) {
    high = low;
    for (int i = 1; i < degree; ++i) {
      if (sign_of(p.b[i], p.e[i]) != 2) continue;
      const int before = sign_of(p.b[i - 1], p.e[i - 1]), after = sign_of(p.b[i + 1], p.e[i + 1]);
      if (before == 2 || after == 2 || before == after) high = degree;
    }
    if (high == 0 && !cut) return true;
  }
  if (low == 1 && high == 1 && !cut) {
    const bool rises_with_t = p.b[0] < 0.0;
    const bool kappa_grows = (part.sigma > 0) != part.outer;
    if (rises_with_t != kappa_grows) return true;  // falls along kappa
    double t = 0, l = 0, h = 0;
    if (!refine(p, degree, t, l, h)) return false;
    const double width = to - from;
    const double k = part.kappa(from + width * t);
    const double k1 = part.kappa(from + width * l), k2 = part.kappa(from + width * h);
    CertifiedRoot& r = out.roots[out.count++];
    r.kappa = k;
    r.error =
        std::fmax(std::fabs(k1 - k), std::fabs(k2 - k)) + 6.1 * u * (std::fabs(k1) + std::fabs(k2));
    return true;
  }
  if (depth == 0) return false;
  Bernstein first = p, second = p;
  for (int k = 1; k <= degree; ++k) {
    for (int i = degree; i >= k; --i) {
      first.b[i] = 0.5 * (first.b[i] + first.b[i - 1]);
      first.e[i] = 0.5 * (first.e[i] + first.e[i - 1]) + 1.1 * u * std::fabs(first.b[i]);
    }
    for (int i = 0; i <= degree - k; ++i) {
      second.b[i] = 0.5 * (second.b[i] + second.b[i + 1]);
      second.e[i] = 0.5 * (second.e[i] + second.e[i + 1]) + 1.1 * u * std::fabs(second.b[i]);
    }
  }
  const double middle = 0.5 * (from + to);
  if (ascending)
    return isolate(first, degree, from, middle, part, ascending, depth - 1, out, most) &&
           isolate(second, degree, middle, to, part, ascending, depth - 1, out, most);
  return isolate(second, degree, middle, to, part, ascending, depth - 1, out, most) &&
         isolate(first, degree, from, middle, part, ascending, depth - 1, out, most);
}

RisingRoots isolated_roots(const Quartic<double>& f, const QuarticError& error, int degree,
                           double scale, int most, double farthest) {
  RisingRoots out;
  // kappa = K x: coefficients and errors of the polynomial in x.
  double c[5], e[5];
  double power = 1.0;
  for (int i = 0; i <= degree; ++i) {
    c[i] = f.q[i] * power;
    e[i] = 1.01 * error.q[i] * power + 5.1 * u * std::fabs(c[i]);
    power *= scale;
  }
  for (int part = 0; part < 4 && out.count < most; ++part) {
    const bool outer = part == 0 || part == 3;
    const double sigma = part < 2 ? 1.0 : -1.0;
    double m[5], n[5];
    for (int i = 0; i <= degree; ++i) {
      const int k = outer ? degree - i : i;  // t = 1/x reverses the coefficients
      m[i] = sigma < 0 && k % 2 == 1 ? -c[k] : c[k];
      n[i] = e[k];
    }
    // Falling kappa: t grows in [K, inf) and in [-K, 0], falls in the others.
    const bool ascending = part == 0 || part == 2;
    const Bernstein p = bernstein(m, n, degree);
    const double passed = outer && sign_of(p.b[0], p.e[0]) == 2 ? scale / farthest : 0.0;
    if (!isolate(p, degree, 0.0, 1.0, {outer, sigma, scale, passed}, ascending, 40, out, most)) {
      out.decided = false;
      return out;
    }
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
                           bool stands) {
  const double eta = row * (f.delta + centre_error + 7.1 * u * e1);
  const double m = 2.01 * row * e1, n1 = 2.01 * row * f.speed_1;
  const double nu = 6.1 * u * row * f.speed_1;
  const double h_size = stands ? 0.0 : m * m + 1.0;
  const double h = stands ? 0.0 : 2.01 * m * eta + 2.01 * eta * eta + 3.1 * u * h_size;
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
