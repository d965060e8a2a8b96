// Student's t.
#pragma once

namespace carom::base {

/// Below which a share `p` of Student's t with so many degrees of freedom lies.
double student_quantile(double p, double degrees);

}  // namespace carom::base
