// Arc length and back. Holes and start points are made here, so the same bits are due everywhere:
// angles come from base/elementary, and the elliptic integral is Carlson's R_F and R_D by his
// duplication theorem, which needs + - * / and sqrt alone (Boost's versions call libm's pow).
#include <cmath>
#include <numbers>

#include "carom/base/elementary.hpp"
#include "carom/geometry/arc_lengths.hpp"
#include "carom/geometry/curve_frame.hpp"
#include "gauss_legendre.hpp"

namespace carom::geometry {

namespace {

using Kind = CurveFrame::Kind;

constexpr double right_angle = std::numbers::pi / 2.0;
constexpr double right_angle_rest = 6.123233995736766e-17;  // pi/2 - right_angle

// Each duplication quarters the spread s of the arguments about their mean. The series cut off
// after the fifth order leave a relative s^6/(4(1 - s)) and 3 s^6/(1 - s)^(3/2) (Carlson 1979):
// less than 2^-53 / 30 at this spread.
constexpr double spread_limit = 1e-3;

/// (1/2) integral from 0 to infinity of dt/sqrt((t + x)(t + y)(t + z)).
double carlson_first(double x, double y, double z) {
  for (;;) {
    const double mean = (x + y + z) / 3.0;
    const double dx = 1.0 - x / mean, dy = 1.0 - y / mean, dz = -(dx + dy);
    if (std::fmax(std::fmax(std::fabs(dx), std::fabs(dy)), std::fabs(dz)) < spread_limit) {
      const double e2 = dx * dy - dz * dz, e3 = dx * dy * dz;
      const double series = 1.0 + e2 * (e2 / 24.0 - 0.1 - 3.0 * e3 / 44.0) + e3 / 14.0;
      return series / std::sqrt(mean);
    }
    const double rx = std::sqrt(x), ry = std::sqrt(y), rz = std::sqrt(z);
    const double shift = rx * ry + ry * rz + rz * rx;
    x = 0.25 * (x + shift);
    y = 0.25 * (y + shift);
    z = 0.25 * (z + shift);
  }
}

/// (3/2) integral from 0 to infinity of dt/sqrt((t + x)(t + y)(t + z)^3).
double carlson_second(double x, double y, double z) {
  double sum = 0.0, weight = 1.0;
  for (;;) {
    const double mean = (x + y + 3.0 * z) / 5.0;
    const double dx = 1.0 - x / mean, dy = 1.0 - y / mean, dz = -(dx + dy) / 3.0;
    if (std::fmax(std::fmax(std::fabs(dx), std::fabs(dy)), std::fabs(dz)) < spread_limit) {
      const double xy = dx * dy, zz = dz * dz;
      const double e2 = xy - 6.0 * zz, e3 = (3.0 * xy - 8.0 * zz) * dz, e4 = 3.0 * (xy - zz) * zz,
                   e5 = xy * dz * zz;
      const double series = 1.0 - 3.0 * e2 / 14.0 + e3 / 6.0 + 9.0 * e2 * e2 / 88.0 -
                            3.0 * e4 / 22.0 - 9.0 * e2 * e3 / 52.0 + 3.0 * e5 / 26.0;
      return 3.0 * sum + weight * series / (mean * std::sqrt(mean));
    }
    const double rx = std::sqrt(x), ry = std::sqrt(y), rz = std::sqrt(z);
    const double shift = rx * ry + ry * rz + rz * rx;
    sum += weight / (rz * (z + shift));
    weight *= 0.25;
    x = 0.25 * (x + shift);
    y = 0.25 * (y + shift);
    z = 0.25 * (z + shift);
  }
}

/// Length of an ellipse from an end of its minor axis over an eccentric angle of at most a right
/// angle, given by its cosine and sine: major E(angle | m) in the form whose terms are all
/// positive.
double from_minor_axis(const CurveFrame& f, double c, double s) {
  const double ratio = f.minor / f.major;
  const double m = (f.major - f.minor) * (f.major + f.minor) / (f.major * f.major);
  const double c2 = c * c, s2 = s * s, d2 = c2 + ratio * ratio * s2;
  const double inner =
      s * carlson_first(c2, d2, 1.0) + m * s2 * s * carlson_second(c2, 1.0, d2) / 3.0;
  return f.major * (ratio * ratio * inner + m * c * s / std::sqrt(d2));
}

/// Place on an ellipse: quarters passed since the end of the minor axis, and the length within the
/// present one.
struct Place {
  int quarters;
  double within;
};

Place place(const CurveFrame& f, double c, double s) {
  const int n = s > 0.0 || (s == 0.0 && c > 0.0) ? (c > 0.0 ? 0 : 1) : (c < 0.0 ? 2 : 3);
  const double x = std::fabs(c), y = std::fabs(s);
  if (n % 2 == 0) return {n, from_minor_axis(f, x, y)};
  return {n, from_minor_axis(f, 0.0, 1.0) - from_minor_axis(f, x, y)};
}

/// Length per unit of u.
double speed(const CurveFrame& f, double u) {
  if (f.bezier) return f.bezier->rate(u);
  const Vector t = direction_at(f, u);
  const double w = u - detail::quarter_number(u);
  return std::sqrt(dot(t, t)) * (2.0 / (1.0 + w * w));
}

/// Length from the start over a short way, where a difference of elliptic integrals would be as
/// inaccurate as the whole ellipse is large: Gauss and Legendre with 8 points. The speed has no
/// zero nearer than |w| of about minor/(2 major), next to an end of the major axis. A sixteenth of
/// that is taken: the zero is 31 half ways from the middle at least, and the rule leaves about
/// 62^-16, less than 2^-53.
double short_length(const CurveFrame& f, double u) {
  return gauss_legendre(0.0, u, [&](double at) { return speed(f, at); });
}

double elliptic_length(const CurveFrame& f, double u) {
  if (u <= 0.0) return 0.0;
  if (u * f.major < 0x1p-5 * f.minor) return short_length(f, u);
  const double quarter = from_minor_axis(f, 0.0, 1.0);
  if (u >= 4.0) return 4.0 * quarter;
  const double n = detail::quarter_number(u), w = u - n;
  const Vector q = detail::quarter_turn(n);
  const double weight = 1.0 + w * w;
  const double along = (1.0 - w) * (1.0 + w) / weight, across = 2.0 * w / weight;
  const double x = q.x * along - q.y * across, y = q.y * along + q.x * across;
  const Vector now{f.phase.x * x - f.phase.y * y, f.phase.y * x + f.phase.x * y};
  const Place first = place(f, f.phase.x, f.phase.y), second = place(f, now.x, now.y);
  // The place has passed n or n + 1 ends of quarters since the start. Rounding does not blur that:
  // the coordinate that changes sign at the n-th is a sum of two terms of one sign.
  int turned = second.quarters - first.quarters;
  while (turned < n) turned += 4;
  return turned * quarter + (second.within - first.within);
}

double circular_parameter(double angle) {
  double n = std::floor(angle / right_angle);
  if (n > 3.0) n = 3.0;
  double rest = (angle - n * right_angle) - n * right_angle_rest;
  if (rest < 0.0 && n > 0.0) {
    n -= 1.0;
    rest += right_angle;
  }
  const elementary::SinCos half = elementary::sincos(0.5 * rest);
  return n + half.sin / half.cos;
}

/// Of curves that are no segment and no circle.
double curved_length(const CurveFrame& f, double u) {
  return f.bezier ? f.bezier->arc_length(u) : elliptic_length(f, u);
}
double curved_parameter(const CurveFrame& f, double s) {
  // Newton, kept inside a shrinking bracket: the length is monotone in u.
  double low = 0.0, high = f.end;
  double u = f.end * (s / curved_length(f, f.end));
  for (int i = 0; i < 100; ++i) {
    const double excess = curved_length(f, u) - s;
    if (excess > 0.0) high = u;
    if (excess < 0.0) low = u;
    double next = u - excess / speed(f, u);
    if (!(next >= low && next <= high)) next = 0.5 * (low + high);
    // No step left, or the last one went to and fro between neighbours, which are 2^-52 u apart at
    // most.
    if (std::fabs(next - u) <= 0x1p-52 * u) return next;
    u = next;
  }
  return u;
}

// `arctangent`: asked on circles only.
double length_by(const CurveFrame& f, double u, const auto& arctangent) {
  if (u <= 0.0) return 0.0;
  if (u > f.end) u = f.end;
  if (f.kind == Kind::segment) return u * f.major;
  if (!f.circular) return curved_length(f, u);
  if (u >= 4.0) return f.major * (2.0 * std::numbers::pi);
  const double n = detail::quarter_number(u);
  return f.major * (n * right_angle + 2.0 * arctangent(u - n));
}

}  // namespace

double arc_length_at(const CurveFrame& f, double u) {
  return length_by(f, u, [](double w) { return elementary::atan2(w, 1.0); });
}

std::vector<double> arc_lengths_at(std::span<const CurveFrame> frames,
                                   std::span<const std::int32_t> curve, std::span<const double> u) {
  std::vector<double> lengths(u.size()), angles;
  std::vector<std::size_t> with_angle;
  const auto length = [&](std::size_t i, const auto& arctangent) {
    lengths[i] = length_by(frames[static_cast<std::size_t>(curve[i])], u[i], arctangent);
  };
  for (std::size_t i = 0; i < u.size(); ++i)
    length(i, [&](double w) {
      angles.push_back(w);
      with_angle.push_back(i);
      return 0.0;
    });
  elementary::atan2(angles, 1.0);
  for (std::size_t k = 0; k < angles.size(); ++k)
    length(with_angle[k], [&](double) { return angles[k]; });
  return lengths;
}

double length(const CurveFrame& f) { return arc_length_at(f, f.end); }

double parameter_at_length(const CurveFrame& f, double s) {
  if (!(s > 0.0)) return 0.0;
  if (s >= length(f)) return f.end;
  const double u = f.kind == Kind::segment ? s / f.major
                   : f.circular            ? circular_parameter(s / f.major)
                                           : curved_parameter(f, s);
  return u < f.end ? u : f.end;
}

}  // namespace carom::geometry
