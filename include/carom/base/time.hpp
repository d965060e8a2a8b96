// Time in two doubles.
#pragma once

namespace carom {

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
    const double sum = t.high + duration;
    const double part = sum - t.high;
    const double error = (t.high - (sum - part)) + (duration - part);
    const double rest = t.low + error;
    const double later = sum + rest;
    return {later, rest - (later - sum)};
  }
  /// Duration from b to a, rounded to one double.
  friend constexpr double operator-(const Time& a, const Time& b) {
    return (a.high - b.high) + (a.low - b.low);
  }
};

}  // namespace carom
