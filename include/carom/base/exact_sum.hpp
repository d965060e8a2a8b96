// Sums of doubles that do not depend on the order of addition.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

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
  using Digits = std::array<std::int64_t, digits>;  // base 2^32, least significant first

  void add_far(std::uint64_t position, std::uint64_t mantissa, bool negative);
  void add_near(std::uint64_t low, std::uint64_t high);
  void shift_near(std::uint64_t lower);
  void spill();
  void spilled();
  Digits all() const;

  // Terms of similar size, the usual ones: a number of 128 bits in two's complement that counts
  // 2^(lowest_ - 1074). Whatever does not fit is in far_, which then has all digits.
  static constexpr std::uint64_t none = std::uint64_t{1} << 32;
  std::uint64_t low_ = 0, high_ = 0, lowest_ = none;
  std::vector<std::int64_t> far_;
  std::uint32_t pending_ = 0;  // additions to far_ since it was last normalised
};

}  // namespace carom
