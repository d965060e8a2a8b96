// The lanes' number: a register, and the few operations that formulas do not name themselves.
#pragma once

#include <bit>
#include <cstddef>
#include <experimental/simd>
#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include "base/inline.hpp"

namespace carom::lanes {
namespace {

namespace simd = std::experimental;
using Real = simd::native_simd<double>;
using Mask = Real::mask_type;
constexpr int width = static_cast<int>(Real::size());
/// Registers side by side where one would wait for itself: as many as there is room for.
#if defined(__AVX512F__)
constexpr int together = 4;
#else
constexpr int together = 2;
#endif

CAROM_INLINE Real choose(const Mask& condition, const Real& yes, const Real& no) {
  Real result = no;
  simd::where(condition, result) = yes;
  return result;
}
using simd::where;  // where(condition, x) = value: in those lanes alone

/// One bit a lane, the first one's lowest.
CAROM_INLINE unsigned bits_of(const Mask& mask) {
#if defined(__AVX512F__)
  return std::bit_cast<unsigned char>(mask);
#else
  const Real signs = choose(mask, Real(-1.0), Real(1.0));
#if defined(__AVX2__)
  return static_cast<unsigned>(_mm256_movemask_pd(static_cast<__m256d>(signs)));
#else
  unsigned bits = 0;
  for (int lane = 0; lane < width; ++lane)
    bits |= static_cast<unsigned>(signs[static_cast<std::size_t>(lane)] < 0.0) << lane;
  return bits;
#endif
#endif
}

/// The nearest whole numbers, below 2^51.
CAROM_INLINE Real rounded(const Real& x) { return (x + 0x1.8p52) - 0x1.8p52; }

/// 0, 1, 2 …: numbers of pieces; last a number for none that may be looked up like 0.
constexpr double no_piece = 0x1p-60;
alignas(64) constexpr double counted[65] = {
    0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20,      21,
    22, 23, 24, 25, 26, 27, 28, 29, 30, 31, 32, 33, 34, 35, 36, 37, 38, 39, 40, 41, 42,      43,
    44, 45, 46, 47, 48, 49, 50, 51, 52, 53, 54, 55, 56, 57, 58, 59, 60, 61, 62, 63, no_piece};

CAROM_INLINE Real load(const double* from) { return Real(from, simd::element_aligned); }
CAROM_INLINE void store(const Real& x, double* to) { x.copy_to(to, simd::element_aligned); }
/// In some lanes alone.
CAROM_INLINE void store_where(const Mask& mask, const Real& x, double* to) {
#if defined(__AVX512F__)
  _mm512_mask_storeu_pd(to, std::bit_cast<__mmask8>(mask), static_cast<__m512d>(x));
#else
  store(choose(mask, x, load(to)), to);  // a masked store takes 30 ns without AVX
#endif
}
/// Masks of all lanes between two stages: a bit a lane, or a number below 0 where it holds. (Not in
/// bytes, which may alias anything.)
template <int lanes>
struct Masks {
#if defined(__AVX512F__)
  unsigned short bits[lanes / width];
#else
  alignas(64) double signs[lanes];
#endif
};
template <int lanes>
CAROM_INLINE void store(const Mask& mask, Masks<lanes>& to, int lane) {
#if defined(__AVX512F__)
  to.bits[lane / width] = std::bit_cast<unsigned char>(mask);
#else
  store(choose(mask, Real(-1.0), Real(1.0)), to.signs + lane);
#endif
}
template <int lanes>
CAROM_INLINE Mask load(const Masks<lanes>& from, int lane) {
#if defined(__AVX512F__)
  return std::bit_cast<Mask>(static_cast<unsigned char>(from.bits[lane / width]));
#else
  return load(from.signs + lane) < 0.0;
#endif
}

/// a b + c, rounded once where the instruction set can: for choices alone, never for a number that
/// shows.
CAROM_INLINE Real fused(const Real& a, const Real& b, const Real& c) {
#if defined(__AVX512F__)
  return Real(
      _mm512_fmadd_pd(static_cast<__m512d>(a), static_cast<__m512d>(b), static_cast<__m512d>(c)));
#elif defined(__FMA__)
  return Real(
      _mm256_fmadd_pd(static_cast<__m256d>(a), static_cast<__m256d>(b), static_cast<__m256d>(c)));
#else
  return a * b + c;
#endif
}
/// p/q, a share of 2^-26 off or less: for choices alone; |q| far from the ends of the doubles'
/// range.
CAROM_INLINE Real nearly_quotient(const Real& p, const Real& q) {
#if defined(__AVX512F__)
  const Real rough(_mm512_rcp14_pd(static_cast<__m512d>(q)));
  return p * fused(rough, fused(-q, rough, Real(1.0)), rough);
#else
  return p / q;
#endif
}
/// The smaller one of two sizes.
CAROM_INLINE Real least_size(const Real& a, const Real& b) {
#if defined(__AVX512DQ__)
  return Real(_mm512_range_pd(static_cast<__m512d>(a), static_cast<__m512d>(b), 0b1010));
#else
  return min(abs(a), abs(b));
#endif
}

/// A size with the sign of another number.
CAROM_INLINE Real signed_like(const Real& size, const Real& sign) {
#if defined(__AVX512F__)
  // One instruction of three operands, for any port.
  const __m512i bit = _mm512_set1_epi64(static_cast<long long>(0x8000000000000000ULL));
  return Real(_mm512_castsi512_pd(
      _mm512_ternarylogic_epi64(bit, _mm512_castpd_si512(static_cast<__m512d>(sign)),
                                _mm512_castpd_si512(static_cast<__m512d>(size)), 0xca)));
#else
  return copysign(size, sign);
#endif
}

/// x, or -x where `sign` is negative.
CAROM_INLINE Real turned_by(const Real& x, const Real& sign) {
#if defined(__AVX512F__)
  const __m512i bit = _mm512_set1_epi64(static_cast<long long>(0x8000000000000000ULL));
  return Real(_mm512_castsi512_pd(
      _mm512_ternarylogic_epi64(_mm512_castpd_si512(static_cast<__m512d>(x)),
                                _mm512_castpd_si512(static_cast<__m512d>(sign)), bit, 0x78)));
#else
  return x * copysign(Real(1.0), sign);
#endif
}

/// How many numbers a look-up may choose from: 8, 16, or more.
enum class Reach { eight, few, all };
/// The widest one whose code is the same here: kernels that differ in nothing else are one.
constexpr Reach reach_here(Reach reach) {
#if defined(__AVX512F__)
  return reach;
#elif defined(__AVX2__)
  return reach == Reach::eight ? Reach::eight : Reach::all;
#else
  return static_cast<void>(reach), Reach::all;
#endif
}

/// table[index], lane by lane; index >= 0.
template <Reach reach>
CAROM_INLINE Real look_up(const double* table, const Real& index) {
#if defined(__AVX512F__)
  const Real bits = index + 0x1p52;  // the lowest bits are the index
  const __m512i i = _mm512_castpd_si512(static_cast<__m512d>(bits));
  if constexpr (reach == Reach::eight)
    return Real(_mm512_permutexvar_pd(i, _mm512_loadu_pd(table)));
  else if constexpr (reach == Reach::few)
    return Real(_mm512_permutex2var_pd(_mm512_loadu_pd(table), i, _mm512_loadu_pd(table + 8)));
  else
    return Real(_mm512_i64gather_pd(_mm512_and_si512(i, _mm512_set1_epi64(0xffff)), table, 8));
#else
#if defined(__AVX2__)
  if constexpr (reach == Reach::eight) {
    // Four numbers are eight words: those of number i are 2i and 2i + 1.
    const __m256i twice =
        _mm256_slli_epi64(_mm256_castpd_si256(static_cast<__m256d>(index + 0x1p52)), 1);
    const __m256i words =
        _mm256_or_si256(_mm256_and_si256(twice, _mm256_set1_epi64x(0xff)),
                        _mm256_slli_epi64(_mm256_add_epi64(twice, _mm256_set1_epi64x(1)), 32));
    const auto among = [&](const double* four) {
      return Real(_mm256_castps_pd(
          _mm256_permutevar8x32_ps(_mm256_castpd_ps(_mm256_loadu_pd(four)), words)));
    };
    return choose(index < 4.0, among(table), among(table + 4));
  }
#endif
  return Real([&](auto i) { return table[static_cast<int>(static_cast<double>(index[i]))]; });
#endif
}

}  // namespace
}  // namespace carom::lanes
