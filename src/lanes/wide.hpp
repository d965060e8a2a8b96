// The lanes' number: a register, and the few operations that formulas do not name themselves. Included by kernel.hpp
// inside the namespace of its instruction set.

using Real = simd::native_simd<double>;
using Mask = Real::mask_type;
constexpr int width = static_cast<int>(Real::size());

INLINE Real choose(const Mask& condition, const Real& yes, const Real& no) {
  Real result = no;
  simd::where(condition, result) = yes;
  return result;
}
using simd::where;  // where(condition, x) = value: in those lanes alone

/// A number or the truth of one lane.
INLINE auto lane_of(const auto& x, int lane) { return x[static_cast<std::size_t>(lane)]; }

INLINE Real load(const double* from) { return Real(from, simd::element_aligned); }
INLINE void store(const Real& x, double* to) { x.copy_to(to, simd::element_aligned); }

/// How many numbers a look-up may choose from.
enum class Reach { few, all };

/// table[index], lane by lane; index >= 0.
template <Reach reach>
INLINE Real look_up(const double* table, const Real& index) {
#if defined(__AVX512F__)
  const Real bits = index + 0x1p52;  // the lowest bits are the index
  const __m512i i = _mm512_castpd_si512(static_cast<__m512d>(bits));
  if constexpr (reach == Reach::few)
    return Real(_mm512_permutex2var_pd(_mm512_loadu_pd(table), i, _mm512_loadu_pd(table + 8)));
  else
    return Real(_mm512_i64gather_pd(_mm512_and_si512(i, _mm512_set1_epi64(0xffff)), table, 8));
#else
  return Real([&](auto i) { return table[static_cast<int>(static_cast<double>(index[i]))]; });
#endif
}
