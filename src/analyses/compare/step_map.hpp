// Does a step of a scheme keep phase-space areas? By differences of the step map.
#pragma once

#include <optional>

#include "analyses/compare/setting.hpp"

namespace carom::analyses {

/// The largest defect of the form sum m (dx^dvx + dy^dvy - omega dx^dy) over steps of that length
/// from places of the reference orbit and pairs of displacements, divided by the form's size, and
/// the error of the differences. Nothing where every step meets a wall.
std::optional<MeasuredNumber> defect_of_areas(const Runs&, const Setting&, const Dynamics&,
                                              double step);

}  // namespace carom::analyses
