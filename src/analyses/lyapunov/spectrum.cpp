#include "carom/analyses/lyapunov/spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "carom/base/error.hpp"

namespace carom {

SpectrumSums::SpectrumSums(const GrowthSums& plan, std::size_t exponents, std::size_t zeros)
    : sums_(exponents + 1, plan), zeros_(zeros) {}

SpectrumSums SpectrumSums::from(std::vector<GrowthSums> sums, std::size_t zeros) {
  SpectrumSums made;
  made.sums_ = std::move(sums);
  made.zeros_ = zeros;
  return made;
}

void SpectrumSums::add(std::span<const double> growth) {
  const std::size_t count = exponents();
  const std::size_t blocks = counted() ? sums_.front().blocks() : 0;
  if (growth.size() != blocks * count) throw InternalError("an orbit with another frame");
  const std::size_t positive = (count - zeros_) / 2;
  OrbitGrowth one;
  one.hits.assign(blocks, 0);
  OrbitGrowth entropy = one;
  entropy.growth.assign(blocks, 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    one.growth.clear();
    for (std::size_t block = 0; block < blocks; ++block) {
      one.growth.push_back(growth[block * count + i]);
      if (i < positive) entropy.growth[block] += one.growth.back();
    }
    sums_[i].add(one);
  }
  sums_.back().add(entropy);
}

void SpectrumSums::merge(const SpectrumSums& other) {
  if (sums_.size() != other.sums_.size() || zeros_ != other.zeros_)
    throw InternalError("sums of another spectrum");
  for (std::size_t i = 0; i < sums_.size(); ++i) sums_[i].merge(other.sums_[i]);
}

SpectrumEstimate estimate_of(const SpectrumSums& sums) {
  SpectrumEstimate e;
  for (const GrowthSums& one : sums.sums()) e.exponents.push_back(mean_growth_of(one).per_time);
  if (e.exponents.empty()) return e;
  e.entropy = e.exponents.back();
  e.exponents.pop_back();
  const std::size_t count = e.exponents.size(), first_zero = (count - sums.zeros()) / 2;
  for (std::size_t i = 0; i < count; ++i) {
    const double value = e.exponents[i].value;
    e.pairing = std::max(e.pairing, std::fabs(value + e.exponents[count - 1 - i].value));
    if (i >= first_zero && i < first_zero + sums.zeros())
      e.largest_zero = std::max(e.largest_zero, std::fabs(value));
  }
  return e;
}

}  // namespace carom
