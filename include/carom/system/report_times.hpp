// Times at which ensembles report.
#pragma once

#include <cstdint>
#include <vector>

namespace carom {

/// `count` values from `first` to `last`, both exact, evenly spaced or with even ratios. The bits
/// are the same everywhere.
std::vector<double> spaced(double first, double last, std::uint64_t count, bool logarithmic);

/// 31 times from t_max/1000 to t_max with even ratios.
std::vector<double> default_report_times(double t_max);

}  // namespace carom
