// How large the force of a typed formula can be near a place: its exact derivatives over complex
// boxes.
#pragma once

#include "carom/forces/typed_expression.hpp"
#include "carom/geometry/curve.hpp"
#include "forces/complex_box.hpp"
#include "forces/force_bound.hpp"

namespace carom::forces {

/// A bound of -grad V, V a formula of x and y.
ForceBound bound_of(const TypedExpression&, const Neighbourhood&);
/// A bound of the force of a pair, W a formula of the distance r.
ForceBound bound_of(const TypedExpression&, double distance, double rho);

/// What a formula of x and y and its slopes can be over a box; without bounds where it is not
/// smooth.
struct ValuesOverBox {
  complex_box::Range value, slope_x, slope_y;
};
ValuesOverBox values_over(const TypedExpression&, const geometry::Box&);

}  // namespace carom::forces
