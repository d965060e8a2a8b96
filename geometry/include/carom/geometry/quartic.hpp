// Real roots of a quartic or cubic with inexact coefficients: a Larmor circle against an ellipse.
#pragma once

#include <cmath>

#include "carom/geometry/filter.hpp"

namespace carom::geometry {

/// A root with an interval that is proven to contain exactly one.
struct CertifiedRoot {
  double kappa = 0.0;
  double error = 0.0;
};

/// The roots of a quartic at which it rises, in increasing order, each with a bound of its error.
struct RisingRoots {
  bool decided = true;  ///< false: the coefficients' errors leave their number or order open
  int count = 0;
  CertifiedRoot roots[4];
};

/// Errors of the coefficients of a quartic.
struct QuarticError {
  double q[5]{};
};

/// The roots at which the polynomial of degree 3 or 4 rises, from the largest to the smallest, over
/// the whole real line. It is cut into [K, inf), [0, K], [-K, 0], (-inf, -K] with the given scale K
/// > 0 and isolated by Descartes' rule in Bernstein form, with every coefficient's error carried
/// along, so that no root is missed and none invented: docs/physics/exactness.md. At most `most`
/// roots are returned. `farthest`: where the leading coefficient's error hides its sign, roots
/// beyond this |kappa| are not asked for; some of them may be missing then, or be among those
/// returned.
RisingRoots rising_roots(const Quartic<double>& f, const QuarticError& error, int degree,
                         double scale, int most = 4, double farthest = HUGE_VAL);

/// The root that the first exit most likely is (first_root.hpp). Of the roots found, the one about
/// it is given this number, however it was isolated: lanes have it from the same
/// operations.
double likely_root(const Quartic<double>& f, int degree);

/// Coefficients' errors for ellipse_quartic; as ellipse_error. `on_wall`: the start lies on the
/// curve.
QuarticError quartic_error(const FlightScale& f, double e1, double centre_error, double row,
                           bool on_wall);

}  // namespace carom::geometry
