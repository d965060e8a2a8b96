// Elementary functions of many numbers at once.
#include <cstddef>

#include "carom/base/elementary.hpp"

#if defined(__x86_64__)
#include <immintrin.h>

// SLEEF's header shows these only to files that are compiled for such machines as a whole.
extern "C" {
[[gnu::target("avx512f")]] __m512d Sleef_cinz_expd8_u10avx512fnofma(__m512d);
[[gnu::target("avx")]] __m256d Sleef_cinz_expd4_u10avx(__m256d);
__m128d Sleef_cinz_expd2_u10sse2(__m128d);
[[gnu::target("avx512f")]] __m512d Sleef_cinz_atan2d8_u10avx512fnofma(__m512d, __m512d);
[[gnu::target("avx")]] __m256d Sleef_cinz_atan2d4_u10avx(__m256d, __m256d);
__m128d Sleef_cinz_atan2d2_u10sse2(__m128d, __m128d);
}
#endif

namespace carom::elementary {

#if defined(__x86_64__)

namespace {

// These functions take the same steps in every lane, so that lanes do not see each other.
[[gnu::target("avx512f")]] void exp_by_eight(double* x, std::size_t n) {
  for (std::size_t i = 0; i < n; i += 8)
    _mm512_storeu_pd(x + i, Sleef_cinz_expd8_u10avx512fnofma(_mm512_loadu_pd(x + i)));
}
[[gnu::target("avx")]] void exp_by_four(double* x, std::size_t n) {
  for (std::size_t i = 0; i < n; i += 4)
    _mm256_storeu_pd(x + i, Sleef_cinz_expd4_u10avx(_mm256_loadu_pd(x + i)));
}
void exp_by_two(double* x, std::size_t n) {
  for (std::size_t i = 0; i < n; i += 2)
    _mm_storeu_pd(x + i, Sleef_cinz_expd2_u10sse2(_mm_loadu_pd(x + i)));
}

[[gnu::target("avx512f")]] void atan2_by_eight(double* y, double x, std::size_t n) {
  for (std::size_t i = 0; i < n; i += 8)
    _mm512_storeu_pd(y + i,
                     Sleef_cinz_atan2d8_u10avx512fnofma(_mm512_loadu_pd(y + i), _mm512_set1_pd(x)));
}
[[gnu::target("avx")]] void atan2_by_four(double* y, double x, std::size_t n) {
  for (std::size_t i = 0; i < n; i += 4)
    _mm256_storeu_pd(y + i, Sleef_cinz_atan2d4_u10avx(_mm256_loadu_pd(y + i), _mm256_set1_pd(x)));
}
void atan2_by_two(double* y, double x, std::size_t n) {
  for (std::size_t i = 0; i < n; i += 2)
    _mm_storeu_pd(y + i, Sleef_cinz_atan2d2_u10sse2(_mm_loadu_pd(y + i), _mm_set1_pd(x)));
}

ExpOfMany widest() {
  if (__builtin_cpu_supports("avx512f")) return exp_by_eight;
  if (__builtin_cpu_supports("avx")) return exp_by_four;
  return exp_by_two;
}

}  // namespace

void exp(std::span<double> x) {
  static const ExpOfMany several = widest();
  const std::size_t whole = x.size() / 8 * 8;
  several(x.data(), whole);
  for (double& one : x.subspan(whole)) one = exp(one);
}

void atan2(std::span<double> y, double x) {
  static const auto several = __builtin_cpu_supports("avx512f") ? atan2_by_eight
                              : __builtin_cpu_supports("avx")   ? atan2_by_four
                                                                : atan2_by_two;
  const std::size_t whole = y.size() / 8 * 8;
  several(y.data(), x, whole);
  for (double& one : y.subspan(whole)) one = atan2(one, x);
}

ExpOfMany exp_by(int width) {
  return width >= 8 ? exp_by_eight : width >= 4 ? exp_by_four : exp_by_two;
}

#else

void exp(std::span<double> x) {
  for (double& one : x) one = exp(one);
}

void atan2(std::span<double> y, double x) {
  for (double& one : y) one = atan2(one, x);
}

ExpOfMany exp_by(int) {
  return [](double* x, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) x[i] = exp(x[i]);
  };
}

#endif

}  // namespace carom::elementary
