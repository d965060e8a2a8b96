// A number of 34 decimal digits, as IEEE 754 calls binary128, for orbits that others are compared
// with. Boost's arithmetic is rounded the same way on every machine.
#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <limits>
#include <string>
#include <string_view>

#include "forces/dual.hpp"

namespace carom::forces {

class Quad {
 public:
  Quad() = default;
  Quad(double x) : n_(x) {}
  static Quad parse(std::string_view decimal) { return Number(std::string(decimal)); }
  double to_double() const { return n_.convert_to<double>(); }

  friend Quad operator+(const Quad& a, const Quad& b) { return Number(a.n_ + b.n_); }
  friend Quad operator-(const Quad& a, const Quad& b) { return Number(a.n_ - b.n_); }
  friend Quad operator*(const Quad& a, const Quad& b) { return Number(a.n_ * b.n_); }
  friend Quad operator/(const Quad& a, const Quad& b) { return Number(a.n_ / b.n_); }
  friend Quad operator-(const Quad& a) { return Number(-a.n_); }
  friend bool operator==(const Quad& a, const Quad& b) { return a.n_ == b.n_; }
  friend bool operator<(const Quad& a, const Quad& b) { return a.n_ < b.n_; }
  friend bool operator>(const Quad& a, const Quad& b) { return a.n_ > b.n_; }
  friend bool operator<=(const Quad& a, const Quad& b) { return a.n_ <= b.n_; }
  friend bool operator>=(const Quad& a, const Quad& b) { return a.n_ >= b.n_; }
  friend Quad sqrt(const Quad& x) { return root(x); }

  // What formulas ask of a number (forces/dual.hpp, forces/formula_evaluation.hpp).
  friend double value_of(const Quad& x) { return x.to_double(); }
  friend Quad absolute(const Quad& x) { return Number(fabs(x.n_)); }
  friend Quad root(const Quad& x) { return Number(sqrt(x.n_)); }
  friend Quad exponential(const Quad& x) { return Number(exp(x.n_)); }
  friend Quad logarithm(const Quad& x) { return Number(log(x.n_)); }
  friend Quad angle(const Quad& y, const Quad& x) { return Number(atan2(y.n_, x.n_)); }
  friend SineAndCosine<Quad> sine_and_cosine(const Quad& x) {
    return {Number(sin(x.n_)), Number(cos(x.n_))};
  }
  friend SineAndCosine<Quad> hyperbolic_sine_and_cosine(const Quad& x) {
    return {Number(sinh(x.n_)), Number(cosh(x.n_))};
  }
  friend ValueAndSlope<Quad> tanh_and_slope(const Quad& x) {
    const Number value = tanh(x.n_);
    return {value, Number(1 - value * value)};
  }
  friend Quad half_power_value(const Quad& x, int m) { return Number(pow(x.n_, m) * sqrt(x.n_)); }
  friend Quad real_power_value(const Quad& x, double c) { return Number(pow(x.n_, Number(c))); }

 private:
  using Number =
      boost::multiprecision::number<boost::multiprecision::cpp_bin_float_quad::backend_type,
                                    boost::multiprecision::et_off>;
  Quad(const Number& n) : n_(n) {}
  Number n_;
};

}  // namespace carom::forces

template <>
struct std::numeric_limits<carom::forces::Quad>
    : std::numeric_limits<boost::multiprecision::cpp_bin_float_quad> {
  static carom::forces::Quad epsilon() { return 0x1p-112; }
  static carom::forces::Quad infinity() { return std::numeric_limits<double>::infinity(); }
};
