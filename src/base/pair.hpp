// Two doubles side by side: what a core does at once on every machine Carom runs on.
#pragma once

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include <array>
#include <cstddef>
#include <cstring>

namespace carom::base {

/// Arithmetic of a Pair is that of its two doubles, each rounded by itself.
using Pair [[gnu::vector_size(16)]] = double;
using PairMask = decltype(Pair{} < Pair{});  // a lane is 0 or -1

inline Pair both(double x) { return Pair{x, x}; }
inline Pair magnitude(Pair x) {
  const PairMask sign = reinterpret_cast<PairMask>(both(-0.0));
  return reinterpret_cast<Pair>(reinterpret_cast<PairMask>(x) & ~sign);
}
inline Pair smaller(Pair a, Pair b) { return a < b ? a : b; }
inline Pair larger(Pair a, Pair b) { return a > b ? a : b; }
/// The second of one pair and the first of the next.
inline Pair between(Pair a, Pair b) { return __builtin_shufflevector(a, b, 1, 2); }
/// Numbers i and i + 1.
template <std::size_t size>
Pair pair_at(const std::array<double, size>& numbers, std::size_t i) {
  Pair pair;
  std::memcpy(&pair, numbers.data() + i, sizeof pair);
  return pair;
}
/// x, or zero.
inline Pair keep_if(bool condition, Pair x) {
  const PairMask mask = PairMask{} - static_cast<decltype(PairMask{}[0] + 0)>(condition);
  return reinterpret_cast<Pair>(reinterpret_cast<PairMask>(x) & mask);
}
/// The numbers where the mask is true, elsewhere zero.
inline Pair keep_if(PairMask mask, Pair x) {
#if defined(__SSE2__)
  return _mm_and_pd(reinterpret_cast<Pair>(mask), x);
#else
  return reinterpret_cast<Pair>(reinterpret_cast<PairMask>(x) & mask);
#endif
}
/// The bits of both numbers together, of which one is zero.
inline Pair either_bits(Pair a, Pair b) {
  return reinterpret_cast<Pair>(reinterpret_cast<PairMask>(a) | reinterpret_cast<PairMask>(b));
}
/// The sign bits (of a mask: its truth), the first lane's lowest.
inline unsigned signs(Pair x) {
#if defined(__SSE2__)
  return static_cast<unsigned>(_mm_movemask_pd(x));
#else
  const PairMask s = reinterpret_cast<PairMask>(x) < 0;
  return static_cast<unsigned>(s[0] & 1) | static_cast<unsigned>(s[1] & 2);
#endif
}
inline unsigned signs(PairMask m) { return signs(reinterpret_cast<Pair>(m)); }

}  // namespace carom::base
