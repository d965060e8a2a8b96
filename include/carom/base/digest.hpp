// What digests of ensembles are made of.
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

/// A hash so far, and the bits of one more number.
constexpr std::uint64_t mix(std::uint64_t so_far, double value) {
  return mix(so_far ^ std::bit_cast<std::uint64_t>(value));
}

/// One trajectory's share, as far as its end and its hits tell it from others; a digest is the sum
/// of such shares modulo 2^64 in any order.
constexpr std::uint64_t trajectory_hash(std::uint64_t index, std::uint64_t fate, double end_time,
                                        std::uint64_t hits, std::int64_t last_wall) {
  std::uint64_t h = mix(index);
  h = mix(h ^ fate);
  h = mix(h, end_time);
  h = mix(h ^ hits);
  return mix(h ^ static_cast<std::uint64_t>(last_wall));
}

}  // namespace carom
