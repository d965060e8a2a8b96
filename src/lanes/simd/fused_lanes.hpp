// a b + c in lanes, each rounded once: on every instruction set the numbers of fused_product of
// doubles.
//
// Included by files of one instruction set alone: the register's type is that set's own. On x86-64
// processors without the instruction nothing may come here: lanes have no kernels there
// (free_lanes.cpp).
#pragma once

#include <experimental/simd>
#if defined(__AVX2__)
#include <immintrin.h>
#endif

#include "carom/base/fused_product.hpp"

namespace carom {

template <>
struct FusedProduct<std::experimental::native_simd<double>> {
  using Real = std::experimental::native_simd<double>;

  [[gnu::always_inline]] static Real of(const Real& a, const Real& b, const Real& c) {
#if defined(__AVX512F__)
    return Real(
        _mm512_fmadd_pd(static_cast<__m512d>(a), static_cast<__m512d>(b), static_cast<__m512d>(c)));
#elif defined(__AVX2__) && defined(__FMA__)
    return Real(
        _mm256_fmadd_pd(static_cast<__m256d>(a), static_cast<__m256d>(b), static_cast<__m256d>(c)));
#elif defined(__x86_64__)
    using Register [[gnu::vector_size(sizeof(Real))]] = double;
    Register sum = static_cast<Register>(c);
    asm("vfmadd231pd %2, %1, %0"
        : "+x"(sum)
        : "x"(static_cast<Register>(a)), "xm"(static_cast<Register>(b)));
    return Real(sum);
#else
    return Real([&](auto i) { return __builtin_fma(double(a[i]), double(b[i]), double(c[i])); });
#endif
  }
};

}  // namespace carom
