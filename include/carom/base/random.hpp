// Counter-based random numbers: a draw is a pure function of (seed, purpose, trajectory, draw).
#pragma once

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
  quasi_random = 8
};

/// Philox4x64-10 (Salmon et al. 2011) with key (seed, purpose) and counter
/// (trajectory, draw / 4, particle or event, 0).
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, Purpose purpose, std::uint64_t trajectory,
               std::uint64_t particle = 0);

  std::uint64_t word();
  /// Uniform in [0, 1): (word >> 11) 2^-53.
  double uniform();
  /// Uniform in the open interval (-1, 1) on an odd lattice: never 0, never an end.
  double symmetric();
  /// A random direction: (x, y) uniform in the unit disc by rejection, not normalised, never (0,0).
  void point_in_disc(double& x, double& y);

 private:
  std::uint64_t key_[2];
  std::uint64_t trajectory_, particle_;
  std::uint64_t draw_ = 0;
  std::uint64_t block_[4] = {};
};

}  // namespace carom
