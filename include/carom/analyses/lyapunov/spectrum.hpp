// All Lyapunov exponents of a system, by the growth of a whole frame of deviations, and the entropy
// that they make. docs/physics/lyapunov.md derives them.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "carom/analyses/lyapunov/growth.hpp"

namespace carom {

/// Sums over orbits of how the lengths of a frame grow.
class SpectrumSums {
 public:
  SpectrumSums() = default;
  /// With the window and the blocks of `plan`, which is empty. `zeros` of the exponents vanish by
  /// conservation laws.
  SpectrumSums(const GrowthSums& plan, std::size_t exponents, std::size_t zeros);

  bool counted() const { return !sums_.empty(); }
  std::size_t exponents() const { return counted() ? sums_.size() - 1 : 0; }
  std::size_t zeros() const { return zeros_; }
  /// `growth`: of the logarithm of each length, in one block of the window after the other.
  void add(std::span<const double> growth);
  void merge(const SpectrumSums&);
  /// Of each exponent, and last of the entropy: the sum of the first half of them, without those
  /// that vanish.
  const std::vector<GrowthSums>& sums() const { return sums_; }
  static SpectrumSums from(std::vector<GrowthSums> sums, std::size_t zeros);

 private:
  std::vector<GrowthSums> sums_;
  std::size_t zeros_ = 0;
};

struct SpectrumEstimate {
  std::vector<Estimate> exponents;  ///< per time, the largest first
  Estimate entropy;                 ///< of Kolmogorov and Sinai, per time
  /// The largest |sum| of the first and the last exponent, the second and the last but one …: 0 but
  /// for rounding where areas of phase space are kept.
  double pairing = 0.0;
  double largest_zero = 0.0;  ///< size of the largest of those that vanish; 0: none does
};
/// Numbers are NaN where nothing was followed to the window's end.
SpectrumEstimate estimate_of(const SpectrumSums&);

}  // namespace carom
