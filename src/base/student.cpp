#include "student.hpp"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/students_t.hpp>

#include <cmath>

namespace carom::base {

namespace {

// Not by way of long double, which is another type on each kind of machine.
using InDoubles = boost::math::policies::policy<boost::math::policies::promote_double<false>>;
using Student = boost::math::students_t_distribution<double, InDoubles>;
using ChiSquared = boost::math::chi_squared_distribution<double, InDoubles>;

}  // namespace

double student_quantile(double p, double degrees) {
  return boost::math::quantile(Student(degrees), p);
}

double student_beyond(double t, double degrees) {
  return 2.0 * boost::math::cdf(boost::math::complement(Student(degrees), std::fabs(t)));
}

double chi_squared_beyond(double value, double degrees) {
  return boost::math::cdf(boost::math::complement(ChiSquared(degrees), value));
}

}  // namespace carom::base
