// Does an exponent still change, because its orbits remember where they started? From how
// deviations grew before and in the window. docs/physics/lyapunov.md derives what this finds.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "carom/analyses/lyapunov/growth.hpp"

namespace carom {

/// Sums over orbits of how much faster deviations grew early than in the last three quarters of the
/// run, orbit by orbit: in T/64 to T/16 (`far`) and in T/16 to T/4 (`near`).
struct DriftSums {
  /// The looks at which lengths are wanted: T/64, T/16, T/4 and T.
  static constexpr std::array<std::size_t, 4> looks{GrowthSums::looks - 7, GrowthSums::looks - 5,
                                                    GrowthSums::looks - 3, GrowthSums::looks - 1};
  using Lengths = std::array<double, looks.size()>;  ///< ln|w| at each

  std::uint64_t orbits = 0;
  ExactSum far, near, far_squares, near_squares, product;  ///< of differences of rates

  /// `end`: T.
  void add(const Lengths&, double end);
  void merge(const DriftSums&);
};

/// What the exponent of the window would be off by if what it drifts by falls as 1/t, and as
/// 1/sqrt(t).
struct Drift {
  Estimate fast, slow;
  bool seen = false;  ///< it is significant, and may be larger than the error of the exponent
};
/// None of fewer orbits than an error needs, or if no sums were kept. `exponent`: of the window.
std::optional<Drift> drift_of(const DriftSums&, const TimeWindow&, const Estimate& exponent);

}  // namespace carom
