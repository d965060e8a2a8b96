#include "certify/flight/larmor_quartic.hpp"

namespace carom::certify {

Interval narrowed(const Powers<Interval>& f, const LarmorExit<Interval>& exit) {
  // The root lies in s, and in m - f(m)/f'(s) for any m of s.
  Interval s{exit.low.low, exit.high.high};
  Interval slope = exit.slope / (exit.high - exit.low);
  for (int step = 0; step < 60; ++step) {
    const Interval m = s.middle();
    const Interval image = m - f.at(m) / slope;
    const Interval next{std::max(s.low, image.low), std::min(s.high, image.high)};
    if (!(next.low <= next.high) || !(next.high - next.low < 0.75 * (s.high - s.low))) break;
    s = next;
    const Interval now = f.slope_at(s);
    if (now.high < slope.high && now.low > slope.low) slope = now;
  }
  return s;
}

Ball narrowed(const Powers<Ball>& f, const LarmorExit<Ball>& exit) {
  const slong bits = Precision::bits();
  Ball s = union_of(exit.low, exit.high), slope = exit.slope / (exit.high - exit.low);
  // The slope holds over the bracket, and later over another ball: a step from a point beside it
  // would prove nothing.
  std::optional<Ball> over;
  const auto holds_at = [&](const Ball& m) {
    if (over) return over->contains(m);
    return sign(m - exit.low) == Sign::positive && sign(exit.high - m) == Sign::positive;
  };
  for (int step = 0; step < 200; ++step) {
    // Twice as many digits as before, if Newton's steps do what they should.
    const double error = s.radius().log2();
    const slong enough =
        static_cast<slong>(std::clamp(64.0 - 3.0 * error, 64.0, static_cast<double>(bits)));
    const Precision precision(enough);
    const Ball m = s.midpoint();
    const Ball image = m - f.at(m) / slope;
    Ball next;
    if (arb_intersection(next.raw(), s.raw(), image.raw(), enough) == 0) break;
    const double improved = next.radius().log2();
    if (!(improved < error - 0.4)) break;
    s = next;
    const Ball now = f.slope_at(s);
    if (now.radius() < slope.radius() || !holds_at(s.midpoint())) {
      slope = now;
      over = s;
    }
  }
  return s;
}

}  // namespace carom::certify
