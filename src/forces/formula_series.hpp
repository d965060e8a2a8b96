// Power series of a typed formula along a curve, with ranges in place of numbers.
#pragma once

#include <array>
#include <span>

#include "carom/forces/typed_expression.hpp"
#include "forces/complex_box.hpp"

namespace carom::forces {

/// f(u), f'(u), f''(u)/2 ... for all u of an interval: coefficient k encloses the k-th derivative
/// over k!. Without bounds where f is not smooth.
using SeriesOfRanges = std::array<complex_box::Range, 7>;

/// Of a formula whose variables are functions of u.
SeriesOfRanges series_along(const TypedExpression&, std::span<const SeriesOfRanges> variables);

}  // namespace carom::forces
