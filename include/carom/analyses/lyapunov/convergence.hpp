// How the exponent of an ensemble settles: its mean over orbits at times from the start on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "carom/base/exact_sum.hpp"
#include "carom/base/fields.hpp"

namespace carom {

/// <ln|w(t)|>/t, which regular orbits make fall as ln(t)/t.
struct ExponentAt {
  double t, lambda;  ///< NaN without orbits
  double error;      ///< by orbits; NaN where there are few, or where starts are quasi-random
};
template <>
struct Fields<ExponentAt> {
  using E = ExponentAt;
  static constexpr std::tuple list{
      field("t", "time", "Time since the start", &E::t),
      field("lambda", "1/time", "Growth of ln|deviation| until t over t, mean over orbits",
            &E::lambda),
      field("lambda_stderr", "1/time",
            "Its standard error, from the scatter of orbits; NaN: fewer than 16, or quasi-random "
            "starts",
            &E::error)};
};

/// Sums over orbits that were followed to the end of the window.
class ConvergenceSums {
 public:
  static constexpr std::size_t most = 64;  ///< times

  ConvergenceSums() = default;
  explicit ConvergenceSums(std::vector<double> times)
      : times_(std::move(times)), sums_(times_.size()) {}

  const std::vector<double>& times() const { return times_; }  ///< increasing
  /// ln|w| at each time, of one orbit.
  void add(std::span<const double> lengths);
  void merge(const ConvergenceSums&);
  /// `errors`: are starts independent?
  std::vector<ExponentAt> exponents(std::uint64_t orbits, bool errors) const;

  struct Sums {
    ExactSum length, square;
  };
  std::vector<Sums>& sums() { return sums_; }
  const std::vector<Sums>& sums() const { return sums_; }

 private:
  std::vector<double> times_;
  std::vector<Sums> sums_;
};

}  // namespace carom
