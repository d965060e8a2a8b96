// Real numbers as balls: a midpoint of any precision and a radius. Every operation encloses: for
// all numbers in its operands' balls the exact result lies in the result's ball (Arb does the
// rounding).
#pragma once

#include <arb.h>

#include <cmath>
#include <string>

#include "carom/base/sign.hpp"

namespace carom::certify {

/// Set by programs that open FLINT late (late/open.cpp). Throws std::system_error where it is not
/// there.
inline void (*open_flint)() = nullptr;

/// Bits that operations round to, in this thread, while a Precision lives.
class Precision {
 public:
  explicit Precision(slong bits) : before_(bits_) {
    if (open_flint != nullptr) open_flint();
    bits_ = bits;
  }
  ~Precision() { bits_ = before_; }
  Precision(const Precision&) = delete;
  Precision& operator=(const Precision&) = delete;
  static slong bits() { return bits_; }
  static void set(slong bits) { bits_ = bits; }

 private:
  static inline thread_local slong bits_ = 64;
  slong before_;
};

/// What one of Arb's functions makes of its operands.
template <class Number>
Number made(auto function, const auto&... of) {
  Number r;
  function(r.raw(), of...);
  return r;
}

/// An upper bound of a size, with an exponent of any length; every operation rounds up.
class Bound {
 public:
  Bound() { mag_init(x_); }
  Bound(double x) : Bound() { mag_set_d(x_, x); }  // NOLINT: |x|, rounded up
  explicit Bound(mag_srcptr x) : Bound() { mag_set(x_, x); }
  Bound(const Bound& o) : Bound() { mag_set(x_, o.x_); }
  Bound(Bound&& o) noexcept : Bound() { mag_swap(x_, o.x_); }
  Bound& operator=(const Bound& o) {
    mag_set(x_, o.x_);
    return *this;
  }
  Bound& operator=(Bound&& o) noexcept {
    mag_swap(x_, o.x_);
    return *this;
  }
  ~Bound() { mag_clear(x_); }

  friend Bound operator+(const Bound& a, const Bound& b) {
    return made<Bound>(mag_add, a.x_, b.x_);
  }
  friend Bound operator*(const Bound& a, const Bound& b) {
    return made<Bound>(mag_mul, a.x_, b.x_);
  }
  friend bool operator<(const Bound& a, const Bound& b) { return mag_cmp(a.x_, b.x_) < 0; }

  /// At least the bound; infinity beyond the range of doubles.
  double to_double() const { return mag_get_d(x_); }
  /// log2, to nine digits; hugely negative for zero.
  double log2() const {
    if (mag_is_inf(x_) != 0) return HUGE_VAL;
    if (mag_is_zero(x_) != 0) return -1e18;
    return fmpz_get_d(MAG_EXPREF(x_)) +
           std::log2(std::ldexp(static_cast<double>(MAG_MAN(x_)), -MAG_BITS));
  }
  mag_srcptr raw() const { return x_; }
  mag_ptr raw() { return x_; }

 private:
  mag_t x_;
};

class Ball {
 public:
  Ball() { arb_init(x_); }
  Ball(int value) : Ball() { arb_set_si(x_, value); }    // NOLINT: exact
  Ball(double value) : Ball() { arb_set_d(x_, value); }  // NOLINT: exact
  Ball(const Ball& o) : Ball() { arb_set(x_, o.x_); }
  Ball(Ball&& o) noexcept : Ball() { arb_swap(x_, o.x_); }
  Ball& operator=(const Ball& o) {
    arb_set(x_, o.x_);
    return *this;
  }
  Ball& operator=(Ball&& o) noexcept {
    arb_swap(x_, o.x_);
    return *this;
  }
  ~Ball() { arb_clear(x_); }

  friend Ball operator+(const Ball& a, const Ball& b) {
    return made<Ball>(arb_add, a.x_, b.x_, Precision::bits());
  }
  friend Ball operator-(const Ball& a, const Ball& b) {
    return made<Ball>(arb_sub, a.x_, b.x_, Precision::bits());
  }
  friend Ball operator-(const Ball& a) { return made<Ball>(arb_neg, a.x_); }
  friend Ball operator*(const Ball& a, const Ball& b) {
    return made<Ball>(arb_mul, a.x_, b.x_, Precision::bits());
  }
  friend Ball operator/(const Ball& a, const Ball& b) {
    return made<Ball>(arb_div, a.x_, b.x_, Precision::bits());
  }

  Ball midpoint() const { return made<Ball>(arb_get_mid_arb, x_); }
  Bound radius() const { return Bound(arb_radref(x_)); }
  /// The ball made larger by `error`.
  Ball widened(const Bound& error) const {
    Ball r = *this;
    arb_add_error_mag(r.x_, error.raw());
    return r;
  }
  /// Rounded to the present precision.
  Ball rounded() const { return made<Ball>(arb_set_round, x_, Precision::bits()); }
  bool contains(const Ball& o) const { return arb_contains(x_, o.x_) != 0; }
  bool overlaps(const Ball& o) const { return arb_overlaps(x_, o.x_) != 0; }
  double to_double() const { return arf_get_d(arb_midref(x_), ARF_RND_NEAR); }
  /// "0.9952…" with that many digits behind the point, the last one rounded.
  std::string decimals(long digits) const;

  arb_ptr raw() { return x_; }
  arb_srcptr raw() const { return x_; }

 private:
  arb_t x_;
};

/// No number of the ball is larger in size.
inline Bound size_of(const Ball& x) { return made<Bound>(arb_get_mag, x.raw()); }

/// The root of a number that is known not to be negative: the part of its ball below zero is
/// ignored.
inline Ball sqrt(const Ball& a) { return made<Ball>(arb_sqrtpos, a.raw(), Precision::bits()); }
inline Ball square(const Ball& a) { return made<Ball>(arb_sqr, a.raw(), Precision::bits()); }
inline Sign sign(const Ball& a) {
  if (arb_is_positive(a.raw()) != 0) return Sign::positive;
  if (arb_is_negative(a.raw()) != 0) return Sign::negative;
  return arb_is_zero(a.raw()) != 0 ? Sign::zero : Sign::undecided;
}

}  // namespace carom::certify
