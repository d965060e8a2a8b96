// The two arithmetics of the reference: quad (113 bits, 34 digits) is the reference itself, long
// double measures how fast nearby orbits separate.
#pragma once

#include <quadmath.h>

#include <cmath>

namespace resolution {

__extension__ typedef __float128 Quad;

inline Quad exponential(Quad x) { return expq(x); }
inline Quad logarithm(Quad x) { return logq(x); }
inline Quad sine(Quad x) { return sinq(x); }
inline Quad cosine(Quad x) { return cosq(x); }
inline Quad root(Quad x) { return sqrtq(x); }
inline Quad size(Quad x) { return x < 0 ? -x : x; }
inline Quad floor_of(Quad x) { return floorq(x); }

inline long double exponential(long double x) { return std::exp(x); }
inline long double logarithm(long double x) { return std::log(x); }
inline long double sine(long double x) { return std::sin(x); }
inline long double cosine(long double x) { return std::cos(x); }
inline long double root(long double x) { return std::sqrt(x); }
inline long double size(long double x) { return std::fabs(x); }
inline long double floor_of(long double x) { return std::floor(x); }

}  // namespace resolution
