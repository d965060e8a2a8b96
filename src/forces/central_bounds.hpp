// Bounds of central forces: their distances from a centre are in [near, far], displaced by at most
// rho.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "carom/base/elementary.hpp"
#include "forces/force_bound.hpp"

namespace carom::forces::central {

inline constexpr double none = std::numeric_limits<double>::infinity();

/// Distances of the points of a box from a centre.
struct Distances {
  double near = 0.0, far = 0.0, rho = 0.0;
};
inline Distances distances(const Neighbourhood& n, geometry::Vector centre) {
  const geometry::Vector low = n.low - centre, high = n.high - centre;
  const double out_x = std::max({low.x, -high.x, 0.0}), out_y = std::max({low.y, -high.y, 0.0});
  const double far_x = std::max(high.x, -low.x), far_y = std::max(high.y, -low.y);
  return {std::sqrt(out_x * out_x + out_y * out_y), std::sqrt(far_x * far_x + far_y * far_y),
          n.rho};
}

/// A force strength * r^exponent, exponent >= 0.
inline double rising(double strength, double exponent, const Distances& d) {
  const double r = d.far + d.rho;
  if (exponent == 0.0) return std::fabs(strength);
  if (exponent == 1.0) return std::fabs(strength) * r;
  if (exponent == 3.0) return std::fabs(strength) * r * r * r;
  return std::fabs(strength) * elementary::exp(exponent * elementary::log(r));
}

/// A force strength * r^-exponent, exponent > 0: singular at the centre.
inline double falling(double strength, double exponent, const Distances& d) {
  const double r = d.near - d.rho;
  if (!(r > 0.0)) return none;
  if (exponent == 2.0) return std::fabs(strength) / (r * r);
  return std::fabs(strength) * elementary::exp(-exponent * elementary::log(r));
}

/// The force (height/width^2) r exp(-r^2/2w^2) of a Gaussian: Re(p q) >= r^2 - 2 r rho - rho^2.
inline double gaussian(double height, double width, const Distances& d) {
  const double r = std::clamp(d.rho, d.near, d.far);
  const double square = r * r - 2.0 * r * d.rho - d.rho * d.rho, w2 = width * width;
  return std::fabs(height) / w2 * (d.far + d.rho) * elementary::exp(-0.5 * square / w2);
}

/// The largest |e^z/(1 + e^z)^2| where |z - z'| <= size for some real z' of [low, high].
inline double logistic_slope(double low, double high, double size) {
  constexpr double half_pi = 1.5707963267948966, theta = 2.356194490192345;  // 3 pi/4
  const double least = std::max({low, -high, 0.0});                          // |Re z'|
  const double least_real = std::max(0.0, least - size);
  // |1 + e^z| >= max(1, |e^z|) sin theta where pi/2 <= |Im z| <= theta, and >= max(1, |e^z|) where
  // less.
  if (size <= half_pi) return elementary::exp(-least_real);
  if (size <= theta) return 2.0 * elementary::exp(-least_real);
  const double beyond =
      least - std::sqrt(size * size - theta * theta);  // |Re z| where |Im z| > theta
  if (!(beyond > 0.0)) return none;
  const double e = elementary::exp(-beyond);
  return std::max(2.0 * elementary::exp(-least_real), e / ((1.0 - e) * (1.0 - e)));
}

/// V = height / (1 + exp((r - radius)/softness)), or with the opposite sign of the exponent. It has
/// a tip at r = 0.
inline ForceBound fermi(double height, double radius, double softness, const Distances& d) {
  const double steepest = std::fabs(height) / softness;
  if (2.0 * d.rho <= d.near) {
    // sqrt(p q) is within rho of r; |p/q| <= (r + rho)/(r - rho).
    const double ratio = std::sqrt((d.near + d.rho) / (d.near - d.rho));
    return {steepest * ratio *
                logistic_slope((d.near - radius) / softness, (d.far - radius) / softness,
                               d.rho / softness),
            0.0};
  }
  const double reach = d.far + d.rho;  // both branches of the root
  const double ratio =
      std::sqrt(3.0);  // as above at most, so that a larger neighbourhood never has a smaller bound
  const double tip = elementary::exp(-radius / softness);
  return {
      steepest * ratio * logistic_slope(-radius / softness, -radius / softness, reach / softness),
      2.0 * steepest * tip / ((1.0 + tip) * (1.0 + tip))};
}

}  // namespace carom::forces::central
