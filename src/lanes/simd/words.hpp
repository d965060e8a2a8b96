// A word of 32 bits for each lane, and its four signed bytes: cells of a lattice.
#pragma once

#include "lanes/simd/real.hpp"

namespace carom::lanes {
namespace {

constexpr hn::Rebind<int, Doubles> ints;
using Words = hn::Vec<hn::Rebind<int, Doubles>>;

CAROM_INLINE Words load(const unsigned* from) {
  return hn::LoadU(ints, reinterpret_cast<const int*>(from));
}
CAROM_INLINE void store(const Words& w, unsigned* to) {
  hn::StoreU(w, ints, reinterpret_cast<int*>(to));
}
CAROM_INLINE Words choose(const Mask& condition, const Words& yes, const Words& no) {
#if HWY_TARGET == HWY_AVX3
  return Words{_mm256_mask_mov_epi32(no.raw, condition.lanes.raw, yes.raw)};
#else
  const Real bits = choose(condition, Real(-1.0), Real(0.0));
  return hn::IfVecThenElse(hn::DemoteTo(ints, bits.lanes), yes, no);
#endif
}
/// Elsewhere 0.
CAROM_INLINE Words only_where(const Mask& condition, const Words& w) {
  return choose(condition, w, hn::Zero(ints));
}
/// Byte by byte, up to the ends of their range.
CAROM_INLINE Words sum_of_bytes(const Words& a, const Words& b) {
  const hn::Repartition<signed char, decltype(ints)> bytes;
  return hn::BitCast(ints, hn::SaturatedAdd(hn::BitCast(bytes, a), hn::BitCast(bytes, b)));
}
/// The upper half in the place of the lower one in some lanes, where the upper half is then any.
CAROM_INLINE Words second_where(const Mask& condition, const Words& w) {
  return choose(condition, hn::ShiftRight<16>(w), w);
}
/// The lower half in both places; elsewhere 0.
CAROM_INLINE Words twice_where(const Mask& condition, const Words& w) {
  const Words lower = hn::And(w, hn::Set(ints, 0xffff));
  return only_where(condition, hn::Or(lower, hn::ShiftLeft<16>(w)));
}
template <int byte>
CAROM_INLINE Real signed_byte(const Words& w) {
  return hn::PromoteTo(doubles, hn::ShiftRight<24>(hn::ShiftLeft<24 - 8 * byte>(w)));
}
/// Adds the lower two bytes of each word to two whole numbers.
CAROM_INLINE void add_cells(const Words& w, int* sums) {
  constexpr hn::Simd<int, 2 * width, 0> pairs;
  const hn::Rebind<unsigned short, Doubles> lower;
  const hn::Rebind<signed char, decltype(pairs)> bytes;
  const auto half = hn::TruncateTo(lower, hn::BitCast(hn::RebindToUnsigned<decltype(ints)>(), w));
  const auto cells = hn::PromoteTo(pairs, hn::BitCast(bytes, half));
  hn::StoreU(hn::Add(hn::LoadU(pairs, sums), cells), pairs, sums);
}

}  // namespace
}  // namespace carom::lanes
