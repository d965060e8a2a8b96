// Student's t.
#pragma once

namespace carom::base {

/// Below which a share `p` of Student's t with this many degrees of freedom lies.
double student_quantile(double p, double degrees);
/// The share that lies farther from 0 than t, on both sides.
double student_beyond(double t, double degrees);

}  // namespace carom::base
