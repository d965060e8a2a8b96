// Where a flight crosses a curve: the numbers kappa that the exact stage compares.
#pragma once

#include <optional>

#include "algebraic_root.hpp"
#include "carom/geometry/formulas.hpp"
#include "dyadic.hpp"

namespace carom::geometry {

/// A crossing in kappa: (p + q sqrt(d)) / r, or a root beyond quadratics.
struct Crossing {
  Dyadic p, q, r{1}, d;
  Quadratic<Dyadic> quadratic;
  std::optional<AlgebraicRoot> root;
  std::optional<AlgebraicRoot> place;  ///< u on a Bézier curve

  AlgebraicRoot algebraic() const;
};

/// p / r.
Crossing rational_crossing(Dyadic p, Dyadic r);
/// The root of a kappa^2 + 2 b kappa + c at which it rises (rising = +1) or falls (-1), if any.
std::optional<Crossing> quadratic_crossing(const Quadratic<Dyadic>& f, int rising = 1);

/// Order of two crossings along kappa: -1 when a < b.
int compare(const Crossing& a, const Crossing& b);
int sign_of_kappa(const Crossing& a);
/// Sign of the quadratic at a crossing.
int sign_at_crossing(const Quadratic<Dyadic>& f, const Crossing& k);
double approximate(const Crossing& k);

}  // namespace carom::geometry
