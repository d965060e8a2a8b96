// Time in two doubles.
#pragma once

namespace carom {

/// The instant high + low a duration later: one, or that of many trajectories.
template <class Number>
struct TwoNumbers {
  Number high, low;
};
template <class Number>
constexpr TwoNumbers<Number> later(const Number& high, const Number& low, const Number& duration) {
  const Number sum = high + duration;
  const Number part = sum - high;
  const Number error = (high - (sum - part)) + (duration - part);
  const Number rest = low + error;
  const Number end = sum + rest;
  return {end, rest - (end - sum)};
}

/// An instant as the unevaluated sum high + low with |low| at most half an ulp of high, so that
/// 10^10 flights can be added without loss (Dekker 1971; Knuth's two-sum). Comparisons use both.
struct Time {
  double high = 0.0;
  double low = 0.0;

  constexpr Time() = default;
  constexpr Time(double value) : high(value) {}  // NOLINT: a double is an instant
  constexpr Time(double h, double l) : high(h), low(l) {}

  constexpr double value() const { return high + low; }

  friend constexpr bool operator==(const Time&, const Time&) = default;
  friend constexpr bool operator<(const Time& a, const Time& b) {
    return a.high < b.high || (a.high == b.high && a.low < b.low);
  }
  friend constexpr bool operator>(const Time& a, const Time& b) { return b < a; }
  friend constexpr bool operator<=(const Time& a, const Time& b) { return !(b < a); }
  friend constexpr bool operator>=(const Time& a, const Time& b) { return !(a < b); }

  /// The instant a duration later.
  friend constexpr Time operator+(const Time& t, double duration) {
    const TwoNumbers<double> s = later(t.high, t.low, duration);
    return {s.high, s.low};
  }
  /// Duration from b to a, rounded to one double.
  friend constexpr double operator-(const Time& a, const Time& b) {
    return (a.high - b.high) + (a.low - b.low);
  }
};

}  // namespace carom
