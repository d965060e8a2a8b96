// Where an arc ends, exactly: its parameter is rational.
#pragma once

#include <gmpxx.h>

#include "exact_curve.hpp"

namespace carom::geometry {

struct ExactEnd {
  int quarter;
  mpq_class w;  ///< in [0, 1)
};

/// `turned`: the start's quarter turn K a in the direction of travel.
ExactEnd end_of(const ExactCurve& arc, const DyadicVector& turned);

}  // namespace carom::geometry
