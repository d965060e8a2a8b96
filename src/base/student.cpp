#include "student.hpp"

#include <boost/math/distributions/students_t.hpp>

namespace carom::base {

double student_quantile(double p, double degrees) {
  return boost::math::quantile(boost::math::students_t_distribution<double>(degrees), p);
}

}  // namespace carom::base
