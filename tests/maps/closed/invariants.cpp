#include <cmath>

#include "maps/closed/maps.hpp"

namespace carom::maps {

template <class Real>
Real focal_product(Real a, Real b, const Phase<Real>& p) {
  const Real focus = std::sqrt((a - b) * (a + b));
  return ((p.x - focus) * p.vy - p.y * p.vx) * ((p.x + focus) * p.vy - p.y * p.vx);
}

template double focal_product(double, double, const Phase<double>&);
template long double focal_product(long double, long double, const Phase<long double>&);

}  // namespace carom::maps
