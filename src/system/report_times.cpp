#include "carom/system/report_times.hpp"

#include "carom/base/elementary.hpp"

namespace carom {

std::vector<double> spaced(double first, double last, std::uint64_t count, bool logarithmic) {
  std::vector<double> values;
  const double low = logarithmic ? elementary::log(first) : 0.0;
  const double range = logarithmic ? elementary::log(last) - low : 0.0;
  for (std::uint64_t k = 0; k < count; ++k) {
    const double part = static_cast<double>(k) / static_cast<double>(count - 1);
    double value =
        logarithmic ? elementary::exp(low + range * part) : first + (last - first) * part;
    if (k == 0) value = first;
    if (k + 1 == count) value = last;
    values.push_back(value);
  }
  return values;
}

std::vector<double> default_report_times(double t_max) {
  return spaced(t_max / 1000.0, t_max, 31, true);
}

}  // namespace carom
