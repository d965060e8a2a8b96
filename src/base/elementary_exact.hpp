// Elementary functions by MPFR: rounded right whatever it takes, some microseconds each.
#pragma once

namespace carom::base::exact {

double sin(double x);
double cos(double x);
double exp(double x);
double log(double x);
double atan2(double y, double x);

}  // namespace carom::base::exact
