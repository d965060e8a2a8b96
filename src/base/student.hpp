// Student's t, and Pearson's chi squared.
#pragma once

namespace carom::base {

/// Below which a share `p` of Student's t with this many degrees of freedom lies.
double student_quantile(double p, double degrees);
/// The share that lies farther from 0 than t, on both sides.
double student_beyond(double t, double degrees);

/// The share of chi squared with this many degrees of freedom that lies beyond a value.
double chi_squared_beyond(double value, double degrees);

}  // namespace carom::base
