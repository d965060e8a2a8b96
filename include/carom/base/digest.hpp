// The digest of an ensemble: equal digests mean the same trajectories bit for bit.
#pragma once

#include <bit>
#include <cstdint>

namespace carom {

/// SplitMix64's finaliser (Steele, Lea & Flood 2014): a bijection of 64-bit words.
constexpr std::uint64_t mix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// One trajectory's share; a digest is the sum of these modulo 2^64 in any order.
constexpr std::uint64_t trajectory_hash(std::uint64_t index, std::uint64_t fate, double end_time,
                                        std::uint64_t hits, std::int64_t last_wall) {
  std::uint64_t h = mix(index);
  h = mix(h ^ fate);
  h = mix(h ^ std::bit_cast<std::uint64_t>(end_time));
  h = mix(h ^ hits);
  return mix(h ^ static_cast<std::uint64_t>(last_wall));
}

}  // namespace carom
