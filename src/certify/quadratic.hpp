// Exact numbers a + b sqrt(d): all rational ones, and those of one square root. Signs are exact, zeros too.
#pragma once

#include <gmpxx.h>

#include <stdexcept>

#include "carom/base/exact_number.hpp"
#include "carom/base/sign.hpp"

namespace carom::certify {

/// A number that has no such form: pi, a second root, or one that is too long.
class NotQuadratic : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The root of numbers in this thread, while a QuadraticField lives: none at first, then the first that is
/// needed.
class QuadraticField {
 public:
  QuadraticField() : before_(radicand()) { radicand() = 0; }
  ~QuadraticField() { radicand() = before_; }
  QuadraticField(const QuadraticField&) = delete;
  QuadraticField& operator=(const QuadraticField&) = delete;

  /// > 1 and no square, or 0.
  static mpz_class& radicand() {
    static thread_local mpz_class value;
    return value;
  }

 private:
  mpz_class before_;
};

class Quadratic {
 public:
  Quadratic() = default;
  Quadratic(int value) : rational_(value) {}     // NOLINT: exact
  Quadratic(double value) : rational_(value) {}  // NOLINT: exact
  explicit Quadratic(mpq_class value) : rational_(std::move(value)) {}
  /// Throws NotQuadratic.
  explicit Quadratic(const ExactNumber&);

  friend Quadratic operator+(const Quadratic& a, const Quadratic& b) {
    return {a.rational_ + b.rational_, a.root_ + b.root_};
  }
  friend Quadratic operator-(const Quadratic& a, const Quadratic& b) {
    return {a.rational_ - b.rational_, a.root_ - b.root_};
  }
  friend Quadratic operator-(const Quadratic& a) { return {-a.rational_, -a.root_}; }
  friend Quadratic operator*(const Quadratic& a, const Quadratic& b);
  friend Quadratic operator/(const Quadratic& a, const Quadratic& b);
  friend bool operator==(const Quadratic& a, const Quadratic& b) {
    return a.rational_ == b.rational_ && a.root_ == b.root_;
  }
  friend Sign sign(const Quadratic&);
  /// Throws NotQuadratic where the root needs another one than the field has.
  friend Quadratic sqrt(const Quadratic&);

  /// The number, where it has no root.
  const mpq_class* rational() const { return sgn(root_) == 0 ? &rational_ : nullptr; }
  /// Of all numerators and denominators together.
  std::size_t bits() const;

 private:
  Quadratic(mpq_class rational, mpq_class root) : rational_(std::move(rational)), root_(std::move(root)) {}
  mpq_class rational_, root_;
};

inline Quadratic square(const Quadratic& a) { return a * a; }

}  // namespace carom::certify
