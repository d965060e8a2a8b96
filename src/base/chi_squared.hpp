// Pearson's chi squared.
#pragma once

namespace carom::base {

/// The share of chi squared with this many degrees of freedom that lies beyond a value.
double chi_squared_beyond(double value, double degrees);

}  // namespace carom::base
