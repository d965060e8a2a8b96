// Two doubles that are computed with side by side, as every target can: the compiler would not do
// so by itself where a number is chosen.
#pragma once

#include <array>
#include <cstddef>
#include <cstring>

namespace carom::events {

using PairOfDoubles [[gnu::vector_size(16)]] = double;

inline PairOfDoubles both(double x) { return PairOfDoubles{x, x}; }
inline PairOfDoubles smaller(PairOfDoubles a, PairOfDoubles b) { return a < b ? a : b; }
inline PairOfDoubles larger(PairOfDoubles a, PairOfDoubles b) { return a > b ? a : b; }
/// The second of one pair and the first of the next.
inline PairOfDoubles between(PairOfDoubles a, PairOfDoubles b) { return PairOfDoubles{a[1], b[0]}; }
/// Numbers i and i + 1.
template <std::size_t size>
PairOfDoubles pair_at(const std::array<double, size>& numbers, std::size_t i) {
  PairOfDoubles pair;
  std::memcpy(&pair, numbers.data() + i, sizeof pair);
  return pair;
}

}  // namespace carom::events
