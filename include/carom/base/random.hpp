// Counter-based random numbers: a draw is a pure function of (seed, purpose, trajectory, draw).
#pragma once

#include <array>
#include <cstdint>

namespace carom {

/// What a stream of random numbers is used for; streams of different purposes are independent.
enum class Purpose : std::uint64_t {
  initial_state = 1,
  injection = 2,
  splitting = 3,
  injection_time = 4,
  swap_test = 6,
  arrangement = 7,
  quasi_random = 8,
  scattering = 9,
  transmission = 10
};

/// Philox4x64-10 (Salmon et al. 2011) with key (seed, purpose) and counter
/// (trajectory, draw / 4, particle or event, 0).
class RandomStream {
 public:
  /// Four words that are drawn one after the other.
  using Block = std::array<std::uint64_t, 4>;
  static void block(std::uint64_t seed, Purpose purpose, std::uint64_t trajectory,
                    std::uint64_t particle, std::uint64_t number, Block& words);

  /// `first`: the number of the block it begins with.
  RandomStream(std::uint64_t seed, Purpose purpose, std::uint64_t trajectory,
               std::uint64_t particle = 0, std::uint64_t first = 0);

  std::uint64_t word();
  /// Uniform in [0, 1): (word >> 11) 2^-53.
  double uniform() { return uniform(word()); }
  static double uniform(std::uint64_t word) { return static_cast<double>(word >> 11) * 0x1p-53; }
  /// Uniform in the open interval (-1, 1) on an odd lattice: never 0, never an end.
  double symmetric() { return symmetric(word()); }
  static double symmetric(std::uint64_t word) {
    // (2k + 1 - 2^53) 2^-53 for 0 <= k < 2^53: an odd integer below 2^53 in size, so every step is
    // exact.
    const auto k = static_cast<std::int64_t>(word >> 11);
    return static_cast<double>(2 * k + 1 - (std::int64_t{1} << 53)) * 0x1p-53;
  }
  /// A random direction: (x, y) uniform in the unit disc by rejection, not normalised, never (0,0).
  void point_in_disc(double& x, double& y) {
    do {
      x = symmetric();
      y = symmetric();
    } while (!in_disc(x, y));
  }
  /// Is one that was drawn in the unit disc? One rounded expression without contraction, so that
  /// every machine draws equally often.
  static bool in_disc(double x, double y) { return x * x + y * y < 1.0; }

 private:
  std::uint64_t seed_;
  Purpose purpose_;
  std::uint64_t trajectory_, particle_;
  std::uint64_t draw_;
  Block block_ = {};
};

}  // namespace carom
