// A number with its error, and the time in which it is measured.
#pragma once

namespace carom {

/// A number with its standard error; NaN where there is none.
struct Estimate {
  double value = 0.0, error = 0.0;
};

/// Report times t with from <= t <= to.
struct TimeWindow {
  double from = 0.0, to = 0.0;
  /// A time of a grid may differ from the intended round number by its rounding.
  bool holds(double t) const { return t > 0.0 && t >= from * (1 - 1e-9) && t <= to * (1 + 1e-9); }
};

}  // namespace carom
