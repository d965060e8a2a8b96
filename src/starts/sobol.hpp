// Points of Sobol' sequences, scrambled at random.
#pragma once

#include <array>
#include <cstdint>

namespace carom::starts {

/// The first three dimensions of the sequence of Sobol' (1967) with the direction numbers of Joe
/// and Kuo (2008), scrambled linearly and shifted digit by digit (Matousek 1998): each point is
/// uniform in [0, 1)^3, and an aligned block of 2^m points has two in each dyadic box of the volume
/// 2^(1-m) whatever the random numbers are. A point is a function of (seed, replicate, index).
class Sobol {
 public:
  static constexpr int dimensions = 3;
  static constexpr int digits = 53;
  using Point = std::array<double, dimensions>;

  Sobol(std::uint64_t seed, std::uint64_t replicate);
  /// Multiples of 2^-53. `index` < 2^53.
  Point point(std::uint64_t index) const;

 private:
  struct Dimension {
    std::array<std::uint64_t, digits> columns{};  ///< of its matrix; the first digit is bit 52
    std::uint64_t shift = 0;
  };
  std::array<Dimension, dimensions> by_dimension_;
};

}  // namespace carom::starts
