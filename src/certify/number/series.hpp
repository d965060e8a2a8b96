// Power series of a few terms over balls: what a function of one number is about it, for all
// numbers of a ball.
#pragma once

#include <arb_poly.h>

#include "certify/number/ball.hpp"

namespace carom::certify {

class Series {
 public:
  /// How many terms series have, in this thread, while it lives.
  class Terms {
   public:
    explicit Terms(slong count) : before_(terms_) { terms_ = count; }
    ~Terms() { terms_ = before_; }
    Terms(const Terms&) = delete;
    Terms& operator=(const Terms&) = delete;

   private:
    slong before_;
  };
  static slong terms() { return terms_; }

  Series() { arb_poly_init(x_); }
  Series(const Ball& constant) : Series() { set(0, constant); }  // NOLINT
  Series(double constant) : Series(Ball(constant)) {}            // NOLINT
  Series(const Series& o) : Series() { arb_poly_set(x_, o.x_); }
  Series(Series&& o) noexcept : Series() { arb_poly_swap(x_, o.x_); }
  Series& operator=(const Series& o) {
    arb_poly_set(x_, o.x_);
    return *this;
  }
  Series& operator=(Series&& o) noexcept {
    arb_poly_swap(x_, o.x_);
    return *this;
  }
  ~Series() { arb_poly_clear(x_); }
  /// The number itself, about a ball.
  static Series variable(const Ball& about) {
    Series r(about);
    r.set(1, 1);
    return r;
  }

  Ball operator[](slong k) const { return made<Ball>(arb_poly_get_coeff_arb, x_, k); }
  void set(slong k, const Ball& value) { arb_poly_set_coeff_arb(x_, k, value.raw()); }
  bool is_constant() const { return arb_poly_length(x_) <= 1; }

  friend Series operator+(const Series& a, const Series& b) {
    return made<Series>(arb_poly_add_series, a.x_, b.x_, terms_, Precision::bits());
  }
  friend Series operator-(const Series& a) { return made<Series>(arb_poly_neg, a.x_); }
  friend Series operator-(const Series& a, const Series& b) { return a + -b; }
  friend Series operator*(const Series& a, const Series& b) {
    return made<Series>(arb_poly_mullow, a.x_, b.x_, terms_, Precision::bits());
  }
  friend Series operator/(const Series& a, const Series& b) {
    return made<Series>(arb_poly_div_series, a.x_, b.x_, terms_, Precision::bits());
  }
  /// The polynomial about another number.
  Series shifted(const Ball& by) const {
    return made<Series>(arb_poly_taylor_shift, x_, by.raw(), Precision::bits());
  }

  arb_poly_struct* raw() { return x_; }
  const arb_poly_struct* raw() const { return x_; }

 private:
  static inline thread_local slong terms_ = 3;
  arb_poly_t x_;
};

}  // namespace carom::certify
