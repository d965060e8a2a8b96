#include "chi_squared.hpp"

#include <boost/math/distributions/chi_squared.hpp>

namespace carom::base {

double chi_squared_beyond(double value, double degrees) {
  return boost::math::cdf(
      complement(boost::math::chi_squared_distribution<double>(degrees), value));
}

}  // namespace carom::base
