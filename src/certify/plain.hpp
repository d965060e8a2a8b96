// MPFR numbers taken at their word: each operation rounds once, and nothing knows how much was lost.
#pragma once

#include <mpfr.h>

#include <string>

#include "carom/base/sign.hpp"

namespace carom::certify {

class Plain {
 public:
  /// Bits of results in this thread, while it lives.
  class Precision {
   public:
    explicit Precision(mpfr_prec_t bits) : before_(mpfr_get_default_prec()) { mpfr_set_default_prec(bits); }
    ~Precision() { mpfr_set_default_prec(before_); }
    Precision(const Precision&) = delete;
    Precision& operator=(const Precision&) = delete;

   private:
    mpfr_prec_t before_;
  };

  Plain() : Plain(0.0) {}
  Plain(int value) : Plain(static_cast<double>(value)) {}  // NOLINT: values convert
  Plain(double value) {                                    // NOLINT
    mpfr_init(x_);
    mpfr_set_d(x_, value, MPFR_RNDN);
  }
  Plain(const Plain& o) {
    mpfr_init(x_);
    mpfr_set(x_, o.x_, MPFR_RNDN);
  }
  Plain(Plain&& o) noexcept : Plain() { mpfr_swap(x_, o.x_); }
  Plain& operator=(const Plain& o) {
    mpfr_set(x_, o.x_, MPFR_RNDN);
    return *this;
  }
  Plain& operator=(Plain&& o) noexcept {
    mpfr_swap(x_, o.x_);
    return *this;
  }
  ~Plain() { mpfr_clear(x_); }

  friend Plain operator+(const Plain& a, const Plain& b) { return made(mpfr_add, a, b); }
  friend Plain operator-(const Plain& a, const Plain& b) { return made(mpfr_sub, a, b); }
  friend Plain operator*(const Plain& a, const Plain& b) { return made(mpfr_mul, a, b); }
  friend Plain operator/(const Plain& a, const Plain& b) { return made(mpfr_div, a, b); }
  friend Plain operator-(const Plain& a) {
    Plain r;
    mpfr_neg(r.x_, a.x_, MPFR_RNDN);
    return r;
  }
  friend Plain sqrt(const Plain& a) {
    Plain r;
    mpfr_sqrt(r.x_, a.x_, MPFR_RNDN);
    return r;
  }
  friend Plain square(const Plain& a) { return a * a; }
  friend Sign sign(const Plain& a) {
    const int s = mpfr_sgn(a.x_);
    return s > 0 ? Sign::positive : s < 0 ? Sign::negative : Sign::zero;
  }

  bool is_number() const { return mpfr_number_p(x_) != 0; }
  double to_double() const { return mpfr_get_d(x_, MPFR_RNDN); }
  /// With as many digits as the precision holds.
  std::string text() const {
    const auto digits = static_cast<int>(static_cast<double>(mpfr_get_prec(x_)) * 0.30103);
    char* printed = nullptr;
    mpfr_asprintf(&printed, "%.*RNg", digits, x_);
    std::string result(printed);
    mpfr_free_str(printed);
    return result;
  }
  mpfr_ptr raw() { return x_; }
  mpfr_srcptr raw() const { return x_; }

 private:
  template <class Operation>
  static Plain made(Operation operation, const Plain& a, const Plain& b) {
    Plain r;
    operation(r.x_, a.x_, b.x_, MPFR_RNDN);
    return r;
  }
  mpfr_t x_;
};

/// For a choice between formulas of the same number.
inline double middle_of(const Plain& x) { return x.to_double(); }

}  // namespace carom::certify
