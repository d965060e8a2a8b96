// Sums of doubles that do not depend on the order of addition.
#pragma once

#include <array>
#include <cstdint>

namespace carom {

/// Exact sum of finite doubles in fixed point over the whole exponent range: add and merge are
/// associative and commutative, so blocks, threads and shards give the same bits.
class ExactSum {
 public:
  void add(double x);
  void merge(const ExactSum& other);
  /// The exact sum rounded once to a double.
  double value() const;
  /// Normalised digits (equal sums have equal digits), for archives and comparison.
  static constexpr int digits = 70;
  std::array<std::int64_t, digits> state() const;
  static ExactSum from_state(const std::array<std::int64_t, digits>& state);

 private:
  void normalise();
  std::array<std::int64_t, digits> digits_{};  // base 2^32, least significant first
  std::uint32_t pending_ = 0;                  // additions since the last normalisation
};

}  // namespace carom
