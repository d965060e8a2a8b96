// A word of 32 bits for each lane, and its four signed bytes: cells of a lattice.
//
// sum_of_bytes(a, b)       byte by byte, up to the ends of their range second_where(lanes, w)
// the upper half in the place of the lower one twice_where(lanes, w)    the lower half in both
// places; elsewhere 0 signed_byte<i>(w)        as a number only_where(lanes, w)     elsewhere 0
// add_cells(w, sums)       the lower two bytes to two whole numbers for each lane
#pragma once

#include "lanes/simd/real.hpp"

namespace carom::lanes {
namespace {

#if defined(__AVX512F__)
using Words = __m256i;
CAROM_INLINE Words load(const unsigned* from) {
  return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
}
CAROM_INLINE void store(const Words& w, unsigned* to) {
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), w);
}
CAROM_INLINE Words sum_of_bytes(const Words& a, const Words& b) { return _mm256_adds_epi8(a, b); }
CAROM_INLINE Words second_where(const Mask& lanes, const Words& w) {
  return _mm256_mask_srli_epi32(w, std::bit_cast<__mmask8>(lanes), w, 16);
}
CAROM_INLINE Words only_where(const Mask& lanes, const Words& w) {
  return _mm256_maskz_mov_epi32(std::bit_cast<__mmask8>(lanes), w);
}
CAROM_INLINE Words twice_where(const Mask& lanes, const Words& w) {
  const __m256i twice =
      _mm256_broadcastsi128_si256(_mm_setr_epi32(0x01000100, 0x05040504, 0x09080908, 0x0d0c0d0c));
  return only_where(lanes, _mm256_shuffle_epi8(w, twice));
}
template <int byte>
CAROM_INLINE Real signed_byte(const Words& w) {
  return Real(_mm512_cvtepi32_pd(_mm256_srai_epi32(_mm256_slli_epi32(w, 24 - 8 * byte), 24)));
}
CAROM_INLINE void add_cells(const Words& w, int* sums) {
  const __m512i cells = _mm512_cvtepi8_epi32(_mm256_cvtepi32_epi16(w));
  _mm512_storeu_si512(sums, _mm512_add_epi32(_mm512_loadu_si512(sums), cells));
}

#elif defined(__SSE2__)
using Words = __m128i;  // of two lanes its lower half
#if defined(__AVX2__)
CAROM_INLINE Words load(const unsigned* from) {
  return _mm_loadu_si128(reinterpret_cast<const __m128i*>(from));
}
CAROM_INLINE void store(const Words& w, unsigned* to) {
  _mm_storeu_si128(reinterpret_cast<__m128i*>(to), w);
}
CAROM_INLINE __m128i upper_words(const Real& x) {
  const __m256 all = _mm256_castpd_ps(static_cast<__m256d>(x));
  return _mm_castps_si128(
      _mm_shuffle_ps(_mm256_castps256_ps128(all), _mm256_extractf128_ps(all, 1), 0b11'01'11'01));
}
CAROM_INLINE Real number_of_words(const __m128i& w) { return Real(_mm256_cvtepi32_pd(w)); }
CAROM_INLINE void add_cells(const Words& w, int* sums) {
  const __m128i pairs =
      _mm_shuffle_epi8(w, _mm_setr_epi8(0, 1, 4, 5, 8, 9, 12, 13, -1, -1, -1, -1, -1, -1, -1, -1));
  auto* to = reinterpret_cast<__m256i*>(sums);
  _mm256_storeu_si256(to, _mm256_add_epi32(_mm256_loadu_si256(to), _mm256_cvtepi8_epi32(pairs)));
}
#else
CAROM_INLINE Words load(const unsigned* from) {
  return _mm_loadl_epi64(reinterpret_cast<const __m128i*>(from));
}
CAROM_INLINE void store(const Words& w, unsigned* to) {
  _mm_storel_epi64(reinterpret_cast<__m128i*>(to), w);
}
CAROM_INLINE __m128i upper_words(const Real& x) {
  return _mm_shuffle_epi32(_mm_castpd_si128(static_cast<__m128d>(x)), 0b11'01'11'01);
}
CAROM_INLINE Real number_of_words(const __m128i& w) { return Real(_mm_cvtepi32_pd(w)); }
CAROM_INLINE void add_cells(const Words& w, int* sums) {
  // Each byte to the upper end of a word of its own.
  const __m128i none = _mm_setzero_si128(), upper = _mm_unpacklo_epi8(none, w);
  const __m128i cells =
      _mm_srai_epi32(_mm_unpacklo_epi16(none, _mm_shuffle_epi32(upper, 0b00'00'10'00)), 24);
  auto* to = reinterpret_cast<__m128i*>(sums);
  _mm_storeu_si128(to, _mm_add_epi32(_mm_loadu_si128(to), cells));
}
#endif
CAROM_INLINE Words all_bits_where(const Mask& lanes) {
  return _mm_srai_epi32(upper_words(choose(lanes, Real(-1.0), Real(1.0))), 31);
}
CAROM_INLINE Words only_where(const Mask& lanes, const Words& w) {
  return _mm_and_si128(all_bits_where(lanes), w);
}
CAROM_INLINE Words sum_of_bytes(const Words& a, const Words& b) { return _mm_adds_epi8(a, b); }
CAROM_INLINE Words second_where(const Mask& lanes, const Words& w) {
  const __m128i there = all_bits_where(lanes);
  return _mm_or_si128(_mm_andnot_si128(there, w), _mm_and_si128(there, _mm_srli_epi32(w, 16)));
}
CAROM_INLINE Words twice_where(const Mask& lanes, const Words& w) {
  const __m128i twice =
      _mm_or_si128(_mm_slli_epi32(w, 16), _mm_srli_epi32(_mm_slli_epi32(w, 16), 16));
  return only_where(lanes, twice);
}
template <int byte>
CAROM_INLINE Real signed_byte(const Words& w) {
  return number_of_words(_mm_srai_epi32(_mm_slli_epi32(w, 24 - 8 * byte), 24));
}

#else
struct Words {
  unsigned word[width];
};
CAROM_INLINE Words load(const unsigned* from) {
  Words w;
  for (int i = 0; i < width; ++i) w.word[i] = from[i];
  return w;
}
CAROM_INLINE void store(const Words& w, unsigned* to) {
  for (int i = 0; i < width; ++i) to[i] = w.word[i];
}
CAROM_INLINE Words sum_of_bytes(const Words& a, const Words& b) {
  Words sum{};
  for (int i = 0; i < width; ++i)
    for (int shift = 0; shift < 32; shift += 8) {
      const int each = static_cast<signed char>(a.word[i] >> shift) +
                       static_cast<signed char>(b.word[i] >> shift);
      sum.word[i] |= (static_cast<unsigned>(each < -128  ? -128
                                            : each > 127 ? 127
                                                         : each) &
                      255u)
                     << shift;
    }
  return sum;
}
CAROM_INLINE Words second_where(const Mask& lanes, Words w) {
  const unsigned bits = bits_of(lanes);
  for (int i = 0; i < width; ++i) w.word[i] >>= (bits >> i & 1u) * 16u;
  return w;
}
CAROM_INLINE Words twice_where(const Mask& lanes, Words w) {
  const unsigned bits = bits_of(lanes);
  for (int i = 0; i < width; ++i) w.word[i] = (bits >> i & 1u) * ((w.word[i] & 0xffffu) * 0x10001u);
  return w;
}
CAROM_INLINE Words only_where(const Mask& lanes, Words w) {
  const unsigned bits = bits_of(lanes);
  for (int i = 0; i < width; ++i) w.word[i] *= bits >> i & 1u;
  return w;
}
CAROM_INLINE void add_cells(const Words& w, int* sums) {
  for (int i = 0; i < width; ++i)
    for (int each = 0; each < 2; ++each)
      sums[2 * i + each] += static_cast<signed char>(w.word[i] >> (8 * each));
}
template <int byte>
CAROM_INLINE Real signed_byte(const Words& w) {
  return Real([&](auto i) {
    return static_cast<double>(static_cast<signed char>(w.word[i] >> (8 * byte)));
  });
}
#endif

}  // namespace
}  // namespace carom::lanes
