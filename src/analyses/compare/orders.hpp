// From errors at several steps to orders and costs.
#pragma once

#include <optional>
#include <vector>

#include "carom/analyses/compare.hpp"

namespace carom::analyses {

/// Larger errors of the state are not in proportion to anything any more.
inline constexpr double largest_error = 0.05;

/// `noise`: of each run, below which its error is rounding. Runs from the longest step on.
MeasuredOrder measured_order(const std::vector<ComparedRun>& runs,
                             const std::vector<double>& noise);

/// The least work from which on the error stays below the wanted one.
std::optional<WorkForError> work_for(const std::vector<ComparedRun>& runs, double error);

}  // namespace carom::analyses
