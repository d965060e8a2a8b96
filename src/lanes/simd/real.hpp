// The lanes' number: a register, by Highway's operations, with the names that formulas use. Where
// an instruction of AVX-512 does more at once, it is named.
#pragma once

// The only checks are of indices whose upper bits the instructions ignore; they would need the
// library.
#define HWY_IS_DEBUG_BUILD 0
// Instructions that no kernel uses, and that a processor need not have.
#define HWY_DISABLE_PCLMUL_AES
#define HWY_DISABLE_F16C
#define TOOLCHAIN_MISS_SYS_AUXV_H  // on ARM: no choice among targets at run time, which would bring
                                   // AES
#include <hwy/highway.h>

#include "base/inline.hpp"
#include "carom/base/fused_product.hpp"

namespace carom::lanes {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Doubles = hn::ScalableTag<double>;
constexpr Doubles doubles;
constexpr int width = static_cast<int>(hn::MaxLanes(doubles));
#if HWY_TARGET == HWY_AVX3
constexpr bool avx512 = true;
#else
constexpr bool avx512 = false;
#endif
/// Registers side by side where one would wait for itself: as many as there is room for.
constexpr int together = avx512 ? 4 : 2;

struct Mask {
  hn::Mask<Doubles> lanes;

  Mask() = default;
  CAROM_INLINE Mask(const hn::Mask<Doubles>& m) : lanes(m) {}
  CAROM_INLINE explicit Mask(bool all) {
#if HWY_TARGET == HWY_AVX3
    lanes.raw = all ? 0xff : 0;
#else
    lanes = hn::MaskFromVec(
        hn::BitCast(doubles, hn::Set(hn::RebindToUnsigned<Doubles>(), all ? ~0ULL : 0ULL)));
#endif
  }
#if HWY_TARGET == HWY_AVX3
  // As numbers, which the compiler merges with comparisons; instructions for masks it does not.
  CAROM_INLINE static Mask of(int bits) { return hn::Mask<Doubles>{static_cast<__mmask8>(bits)}; }
  CAROM_INLINE friend Mask operator&&(const Mask& a, const Mask& b) {
    return of(a.lanes.raw & b.lanes.raw);
  }
  CAROM_INLINE friend Mask operator||(const Mask& a, const Mask& b) {
    return of(a.lanes.raw | b.lanes.raw);
  }
  CAROM_INLINE friend Mask operator!(const Mask& a) { return of(~a.lanes.raw); }
#else
  CAROM_INLINE friend Mask operator&&(const Mask& a, const Mask& b) {
    return hn::And(a.lanes, b.lanes);
  }
  CAROM_INLINE friend Mask operator||(const Mask& a, const Mask& b) {
    return hn::Or(a.lanes, b.lanes);
  }
  CAROM_INLINE friend Mask operator!(const Mask& a) { return hn::Not(a.lanes); }
#endif
  CAROM_INLINE friend Mask operator==(const Mask& a, const Mask& b) {
    return (a && b) || !(a || b);
  }
};
CAROM_INLINE bool any_of(const Mask& a) { return !hn::AllFalse(doubles, a.lanes); }
CAROM_INLINE bool all_of(const Mask& a) { return hn::AllTrue(doubles, a.lanes); }
/// One bit a lane, the first one's lowest.
CAROM_INLINE unsigned bits_of(const Mask& a) {
  unsigned char bits[8];
  hn::StoreMaskBits(doubles, a.lanes, bits);
  return bits[0];
}

struct Real {
  hn::Vec<Doubles> lanes;

  Real() = default;
  CAROM_INLINE Real(const hn::Vec<Doubles>& x) : lanes(x) {}
  CAROM_INLINE Real(double x) : lanes(hn::Set(doubles, x)) {}
  CAROM_INLINE friend Real operator+(const Real& a, const Real& b) {
    return hn::Add(a.lanes, b.lanes);
  }
  CAROM_INLINE friend Real operator-(const Real& a, const Real& b) {
    return hn::Sub(a.lanes, b.lanes);
  }
  CAROM_INLINE friend Real operator*(const Real& a, const Real& b) {
    return hn::Mul(a.lanes, b.lanes);
  }
  CAROM_INLINE friend Real operator/(const Real& a, const Real& b) {
    return hn::Div(a.lanes, b.lanes);
  }
  // As a compiler's operation, which products take in.
  CAROM_INLINE friend Real operator-(const Real& a) {
#if HWY_ARCH_X86 && HWY_TARGET != HWY_EMU128 && HWY_TARGET != HWY_SCALAR
    return hn::Vec<Doubles>{-a.lanes.raw};
#else
    return hn::Neg(a.lanes);
#endif
  }
  CAROM_INLINE friend Mask operator<(const Real& a, const Real& b) {
    return hn::Lt(a.lanes, b.lanes);
  }
  CAROM_INLINE friend Mask operator>(const Real& a, const Real& b) {
    return hn::Gt(a.lanes, b.lanes);
  }
  CAROM_INLINE friend Mask operator<=(const Real& a, const Real& b) {
    return hn::Le(a.lanes, b.lanes);
  }
  CAROM_INLINE friend Mask operator>=(const Real& a, const Real& b) {
    return hn::Ge(a.lanes, b.lanes);
  }
  CAROM_INLINE friend Mask operator==(const Real& a, const Real& b) {
    return hn::Eq(a.lanes, b.lanes);
  }
  CAROM_INLINE friend Mask operator!=(const Real& a, const Real& b) {
    return hn::Ne(a.lanes, b.lanes);
  }
};
CAROM_INLINE Real sqrt(const Real& a) { return hn::Sqrt(a.lanes); }
CAROM_INLINE Real abs(const Real& a) { return hn::Abs(a.lanes); }
CAROM_INLINE Real min(const Real& a, const Real& b) { return hn::Min(a.lanes, b.lanes); }
CAROM_INLINE Real max(const Real& a, const Real& b) { return hn::Max(a.lanes, b.lanes); }
CAROM_INLINE Real choose(const Mask& condition, const Real& yes, const Real& no) {
  return hn::IfThenElse(condition.lanes, yes.lanes, no.lanes);
}
/// where(condition, x) = value: in those lanes alone.
struct ChosenLanes {
  Mask condition;
  Real& x;
  CAROM_INLINE void operator=(const Real& value) { x = choose(condition, value, x); }
};
CAROM_INLINE ChosenLanes where(const Mask& condition, Real& x) { return {condition, x}; }

/// The nearest whole numbers, below 2^51.
CAROM_INLINE Real rounded(const Real& x) { return (x + 0x1.8p52) - 0x1.8p52; }

/// 0, 1, 2 …: numbers of pieces; last a number for none that may be looked up like 0.
constexpr double no_piece = 0x1p-60;
alignas(64) constexpr double counted[65] = {
    0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20,      21,
    22, 23, 24, 25, 26, 27, 28, 29, 30, 31, 32, 33, 34, 35, 36, 37, 38, 39, 40, 41, 42,      43,
    44, 45, 46, 47, 48, 49, 50, 51, 52, 53, 54, 55, 56, 57, 58, 59, 60, 61, 62, 63, no_piece};

CAROM_INLINE Real load(const double* from) { return hn::LoadU(doubles, from); }
CAROM_INLINE void store(const Real& x, double* to) { hn::StoreU(x.lanes, doubles, to); }
/// In some lanes alone.
CAROM_INLINE void store_where(const Mask& mask, const Real& x, double* to) {
  if constexpr (avx512)
    hn::BlendedStore(x.lanes, mask.lanes, doubles, to);
  else
    store(choose(mask, x, load(to)), to);  // a masked store takes 30 ns without AVX
}
/// Masks of many lanes between two stages: a bit a lane, or all bits of a number. (Not in bytes,
/// which may alias anything.)
template <int lanes>
struct Masks {
#if HWY_TARGET == HWY_AVX3
  unsigned short bits[lanes / width];
#else
  alignas(64) double numbers[lanes];
#endif
};
template <int lanes>
CAROM_INLINE void store(const Mask& mask, Masks<lanes>& to, int lane) {
#if HWY_TARGET == HWY_AVX3
  to.bits[lane / width] = mask.lanes.raw;
#else
  store(hn::VecFromMask(doubles, mask.lanes), to.numbers + lane);
#endif
}
template <int lanes>
CAROM_INLINE Mask load(const Masks<lanes>& from, int lane) {
#if HWY_TARGET == HWY_AVX3
  return hn::Mask<Doubles>{static_cast<__mmask8>(from.bits[lane / width])};
#else
  return hn::MaskFromVec(load(from.numbers + lane).lanes);
#endif
}

/// a b + c, rounded once where the instruction set can: for choices alone, never for a number that
/// shows.
CAROM_INLINE Real fused(const Real& a, const Real& b, const Real& c) {
  return hn::MulAdd(a.lanes, b.lanes, c.lanes);
}
/// p/q, a share of 2^-26 off or less: for choices alone; |q| far from the ends of the doubles'
/// range.
CAROM_INLINE Real nearly_quotient(const Real& p, const Real& q) {
#if HWY_TARGET == HWY_AVX3
  const Real rough(hn::Vec<Doubles>{_mm512_rcp14_pd(q.lanes.raw)});
  return p * fused(rough, fused(-q, rough, Real(1.0)), rough);
#else
  return p / q;
#endif
}
/// The smaller one of two sizes.
CAROM_INLINE Real least_size(const Real& a, const Real& b) {
#if HWY_TARGET == HWY_AVX3
  return hn::Vec<Doubles>{_mm512_range_pd(a.lanes.raw, b.lanes.raw, 0b1010)};
#else
  return min(abs(a), abs(b));
#endif
}
/// A size with the sign of another number.
CAROM_INLINE Real signed_like(const Real& size, const Real& sign) {
  return hn::CopySign(size.lanes, sign.lanes);
}
/// x, or -x where `sign` is negative.
CAROM_INLINE Real turned_by(const Real& x, const Real& sign) {
  return hn::Xor(x.lanes, hn::And(sign.lanes, hn::SignBit(doubles)));
}

/// How many numbers a look-up may choose from: 8, 16, or more.
enum class Reach { eight, few, all };
/// The widest one whose code is the same here: kernels that differ in nothing else are one.
constexpr Reach reach_here(Reach reach) {
#if HWY_TARGET == HWY_AVX3
  return reach;
#elif HWY_TARGET == HWY_AVX2
  return reach == Reach::eight ? Reach::eight : Reach::all;
#else
  return static_cast<void>(reach), Reach::all;
#endif
}

/// table[index], lane by lane; index >= 0.
template <Reach reach>
CAROM_INLINE Real look_up(const double* table, const Real& index) {
  const hn::RebindToUnsigned<Doubles> words;
  const auto bits = hn::BitCast(words, (index + 0x1p52).lanes);  // the lowest ones are the index
#if HWY_TARGET == HWY_AVX3
  if constexpr (reach == Reach::eight)
    return hn::TableLookupLanes(load(table).lanes, hn::IndicesFromVec(doubles, bits));
  else if constexpr (reach == Reach::few)
    return hn::Vec<Doubles>{
        _mm512_permutex2var_pd(load(table).lanes.raw, bits.raw, load(table + 8).lanes.raw)};
  else
    return hn::GatherIndex(
        doubles, table,
        hn::BitCast(hn::RebindToSigned<Doubles>(), hn::And(bits, hn::Set(words, 0xffff))));
#else
  if constexpr (reach_here(reach) == Reach::eight) {
    const auto indices = hn::IndicesFromVec(doubles, bits);
    const auto among = [&](const double* four) -> Real {
      return hn::TableLookupLanes(load(four).lanes, indices);
    };
    return choose(index < 4.0, among(table), among(table + 4));
  } else {
    alignas(64) double of[width];
    store(index, of);
    for (double& x : of) x = table[static_cast<int>(x)];
    return load(of);
  }
#endif
}

}  // namespace
}  // namespace carom::lanes

namespace carom {

/// On every instruction set the number of fused_product of doubles. On x86-64 processors without
/// the instruction lanes have no kernels (free/kernels.cpp).
template <>
struct FusedProduct<lanes::Real> {
  CAROM_INLINE static lanes::Real of(const lanes::Real& a, const lanes::Real& b,
                                     const lanes::Real& c) {
#if defined(__x86_64__) && !defined(__FMA__)
    auto sum = c.lanes;
    asm("vfmadd231pd %2, %1, %0" : "+x"(sum.raw) : "x"(a.lanes.raw), "xm"(b.lanes.raw));
    return sum;
#else
    return lanes::fused(a, b, c);
#endif
  }
};

}  // namespace carom
