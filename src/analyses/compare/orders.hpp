// From errors at several steps to orders and costs; defects of areas.
#pragma once

#include <optional>
#include <vector>

#include "analyses/compare/setting.hpp"
#include "carom/analyses/compare.hpp"

namespace carom::analyses {

/// Larger errors of the state are not in proportion to anything any more.
inline constexpr double largest_error = 0.05;

/// `noise`: of each run, below which its error is rounding. Runs from the longest step on.
MeasuredOrder measured_order(const std::vector<ComparedRun>& runs,
                             const std::vector<double>& noise);

/// The least work from which on the error stays below the wanted one.
std::optional<WorkForError> work_for(const std::vector<ComparedRun>& runs, double error);

/// The largest defect of the form sum m (dx^dvx + dy^dvy - omega dx^dy) over steps of that length
/// from places of the reference orbit and pairs of displacements, divided by the form's size, and
/// the error of the differences. Nothing where every step meets a wall.
std::optional<MeasuredNumber> defect_of_areas(const Runs&, const Setting&, const Dynamics&,
                                              double step);

}  // namespace carom::analyses
