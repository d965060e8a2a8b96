// Rational numbers, in which ties of straight flights are decided. Other numbers stay unknown:
// nothing is said of them.
#pragma once

#include <gmpxx.h>

#include <optional>
#include <stdexcept>
#include <utility>

#include "base/expression.hpp"
#include "carom/base/sign.hpp"

namespace carom::certify {

/// The sign of an unknown number was asked for, or a number grew too long.
class NotRational : public std::runtime_error {
 public:
  NotRational() : std::runtime_error("not a rational number") {}
};

/// A rational number, or an unknown one: a number written with roots or pi, or the root of no
/// square.
class Rational {
 public:
  Rational() : value_(0) {}
  Rational(int value) : value_(value) {}     // NOLINT: exact
  Rational(double value) : value_(value) {}  // NOLINT: exact
  explicit Rational(mpq_class value) : value_(std::move(value)) {}
  explicit Rational(const ExactNumber& number) : value_(0) {
    if (!number.expression()) return;
    const ExactNumber::Node& x = *number.expression();
    if (x.operation == ExactNumber::Node::Operation::leaf && x.closed.is_rational())
      value_ = x.closed.coefficient;
    else
      value_.reset();
  }
  static Rational unknown() {
    Rational r;
    r.value_.reset();
    return r;
  }

  friend Rational operator+(const Rational& a, const Rational& b) {
    return a.value_ && b.value_ ? Rational(mpq_class(*a.value_ + *b.value_)) : unknown();
  }
  friend Rational operator-(const Rational& a, const Rational& b) {
    return a.value_ && b.value_ ? Rational(mpq_class(*a.value_ - *b.value_)) : unknown();
  }
  friend Rational operator-(const Rational& a) { return Rational(0) - a; }
  friend Rational operator*(const Rational& a, const Rational& b) {
    return a.value_ && b.value_ ? Rational(mpq_class(*a.value_ * *b.value_)) : unknown();
  }
  friend Rational operator/(const Rational& a, const Rational& b) {
    return a.value_ && b.value_ && sgn(*b.value_) != 0 ? Rational(mpq_class(*a.value_ / *b.value_))
                                                       : unknown();
  }
  friend Rational square(const Rational& a) { return a * a; }
  friend Rational sqrt(const Rational& a) {
    const auto is_square = [](const mpz_class& n) {
      return mpz_perfect_square_p(n.get_mpz_t()) != 0;
    };
    if (!a.value_ || !is_square(a.value_->get_num()) || !is_square(a.value_->get_den()))
      return unknown();
    return Rational(mpq_class(sqrt(a.value_->get_num()), sqrt(a.value_->get_den())));
  }
  /// Throws NotRational where the number is unknown.
  friend Sign sign(const Rational& a) {
    if (!a.value_) throw NotRational();
    const int s = sgn(*a.value_);
    return s > 0 ? Sign::positive : s < 0 ? Sign::negative : Sign::zero;
  }

  /// The number, or null where it is unknown.
  const mpq_class* value() const { return value_ ? &*value_ : nullptr; }

 private:
  std::optional<mpq_class> value_;
};

inline bool is_zero(const Rational& x) { return sign(x) == Sign::zero; }

}  // namespace carom::certify
