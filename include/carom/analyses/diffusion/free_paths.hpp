// Lengths of free flights: their distribution between hits and from the start.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "carom/analyses/diffusion/mean_square_displacement.hpp"
#include "carom/base/exact_sum.hpp"
#include "carom/results/binary_bins.hpp"

namespace carom {

/// What a particle's flights were.
struct FlightsOfParticle {
  std::vector<double> between;   ///< lengths of flights that began at a hit
  std::vector<double> at_start;  ///< length of the flight from the start; empty: not known
  std::uint64_t hits = 0;
  double path = 0.0;  ///< length of all that it flew
};

/// Numbers of flights by length, apart for each group of trajectories (as DisplacementSums). A
/// flight of `limit` or more is only counted as longer.
class FreePathSums {
 public:
  static constexpr std::size_t groups = DisplacementSums::groups;
  using Bins = BinaryBins<3>;  ///< eight to a factor of two

  struct Flights {
    Bins bins;
    std::uint64_t longer = 0;
    void operator+=(const Flights&);
  };
  struct Sum {
    Flights between, at_start;
    std::uint64_t hits = 0;
    ExactSum path;
    void operator+=(const Sum&);
  };

  FreePathSums() = default;
  explicit FreePathSums(double limit) : limit_(limit), sums_(groups) {}

  /// False: nothing was asked for.
  bool counted() const { return !sums_.empty(); }
  double limit() const { return limit_; }
  void add(std::uint64_t trajectory, const FlightsOfParticle&);
  void merge(const FreePathSums& other);
  const Sum& of(std::size_t group) const { return sums_[group]; }
  /// Adds what was kept of one group.
  void merge(std::size_t group, const Sum& other) { sums_[group] += other; }

 private:
  double limit_ = 0.0;
  std::vector<Sum> sums_;
};

/// Flights of from <= length < to.
struct FreePathBin {
  double from = 0.0, to = 0.0;
  std::uint64_t count = 0;
  Estimate density;  ///< share of all flights per length
  Estimate longer;   ///< share of those that are at least `from` long
};

template <>
struct Fields<FreePathBin> {
  using B = FreePathBin;
  static constexpr std::tuple list{
      field("from", "length", "Start of the bin", &B::from),
      field("to", "length", "End of the bin", &B::to),
      field("count", "1", "Flights of from <= length < to", &B::count),
      field_as<double>(
          "density", "1/length", "Share of all flights, per length",
          [](auto& b) -> auto& { return b.density.value; }),
      field_as<double>(
          "density_stderr", "1/length", "Its standard error",
          [](auto& b) -> auto& { return b.density.error; }),
      field_as<double>(
          "longer", "1", "Share of the flights that are at least `from` long",
          [](auto& b) -> auto& { return b.longer.value; }),
      field_as<double>(
          "longer_stderr", "1", "Its standard error",
          [](auto& b) -> auto& { return b.longer.error; })};
};

/// Between two lengths, a factor of four apart, of which the longer one is exceeded by at least
/// 100 flights and the shorter one is 16 mean lengths or more.
struct FreePathTail {
  double from = 0.0, to = 0.0;
  Estimate exponent;  ///< a of (share of longer flights) ~ length^-a
  /// Length times the share of longer flights from the start; of flights between hits length^2
  /// times their share over the mean length. Where free corridors exist, both tend to flight_tail.
  Estimate amplitude;
};

struct FreePathDistribution {
  std::uint64_t flights = 0, longer = 0;
  std::vector<FreePathBin> bins;  ///< the first one begins at 0
  std::optional<FreePathTail> tail;
};

struct FreePaths {
  double limit = 0.0;
  Estimate mean;  ///< length of all that was flown, over the number of hits; NaN: there are none
  FreePathDistribution between, at_start;
};
/// Errors are the jackknife's over groups of trajectories.
FreePaths free_paths_of(const FreePathSums&);

}  // namespace carom
