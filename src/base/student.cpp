#include "student.hpp"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/students_t.hpp>

#include <cmath>

namespace carom::base {

double student_quantile(double p, double degrees) {
  return boost::math::quantile(boost::math::students_t_distribution<double>(degrees), p);
}

double student_beyond(double t, double degrees) {
  const boost::math::students_t_distribution<double> student(degrees);
  return 2.0 * boost::math::cdf(boost::math::complement(student, std::fabs(t)));
}

double chi_squared_beyond(double value, double degrees) {
  return boost::math::cdf(
      complement(boost::math::chi_squared_distribution<double>(degrees), value));
}

}  // namespace carom::base
