#include "carom/analyses/lyapunov/convergence.hpp"

#include "carom/analyses/lyapunov/growth.hpp"
#include "carom/base/error.hpp"
#include "results/numbers.hpp"

namespace carom {

void ConvergenceSums::add(std::span<const double> lengths) {
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    sums_[i].length.add(lengths[i]);
    sums_[i].square.add(lengths[i] * lengths[i]);
  }
}

void ConvergenceSums::merge(const ConvergenceSums& other) {
  if (sums_.size() != other.sums_.size()) throw InternalError("sums of other times");
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    sums_[i].length.merge(other.sums_[i].length);
    sums_[i].square.merge(other.sums_[i].square);
  }
}

std::vector<ExponentAt> ConvergenceSums::exponents(std::uint64_t orbits, bool errors) const {
  std::vector<ExponentAt> list;
  const auto n = static_cast<double>(orbits);
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    const double t = times_[i], mean = sums_[i].length.value() / n;
    const double error =
        errors && orbits >= GrowthSums::enough_blocks
            ? results::root((sums_[i].square.value() / n - mean * mean) / (n - 1.0)) / t
            : results::nan;
    list.push_back({t, mean / t, error});
  }
  return list;
}

}  // namespace carom
