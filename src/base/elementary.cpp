#include "carom/base/elementary.hpp"

#include <sleef.h>

// SLEEF's "cinz" functions use neither fused multiply-add nor instructions that depend on the CPU
// found at run time: each is one fixed chain of IEEE operations. On x86-64 the SSE2 ones serve, as
// they are four times as fast as the scalar ones and give the same bits. The argument is copied
// into both lanes because SLEEF chooses its reduction for all lanes together: another value in the
// second lane could change the last bit of the first.
namespace carom::elementary {

#if defined(__SSE2__)

namespace {
double first(__m128d x) { return _mm_cvtsd_f64(x); }
}  // namespace

double sin(double x) { return first(Sleef_cinz_sind2_u10sse2(_mm_set1_pd(x))); }
double cos(double x) { return first(Sleef_cinz_cosd2_u10sse2(_mm_set1_pd(x))); }
SinCos sincos(double x) {
  const auto both = Sleef_cinz_sincosd2_u10sse2(_mm_set1_pd(x));
  return {first(both.x), first(both.y)};
}
double atan2(double y, double x) {
  return first(Sleef_cinz_atan2d2_u10sse2(_mm_set1_pd(y), _mm_set1_pd(x)));
}
double exp(double x) { return first(Sleef_cinz_expd2_u10sse2(_mm_set1_pd(x))); }
double log(double x) { return first(Sleef_cinz_logd2_u10sse2(_mm_set1_pd(x))); }

#else

double sin(double x) { return Sleef_cinz_sind1_u10purec(x); }
double cos(double x) { return Sleef_cinz_cosd1_u10purec(x); }
SinCos sincos(double x) {
  const auto both = Sleef_cinz_sincosd1_u10purec(x);
  return {both.x, both.y};
}
double atan2(double y, double x) { return Sleef_cinz_atan2d1_u10purec(y, x); }
double exp(double x) { return Sleef_cinz_expd1_u10purec(x); }
double log(double x) { return Sleef_cinz_logd1_u10purec(x); }

#endif

}  // namespace carom::elementary
