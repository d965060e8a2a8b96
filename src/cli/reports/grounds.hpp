// What a report rests on, and what was not looked at: its last line.
#pragma once

#include <string>

#include "carom/events/step_counts.hpp"
#include "carom/system/system.hpp"

namespace carom::cli {

/// "checked: …; not: …", in lines that fit.
std::string grounds_text(const std::string& checked, const std::string& unchecked);
/// Of an ensemble; `errors`: it has standard errors or intervals, whose coverage was tried.
std::string grounds_text(const System&, const StepCounts&, bool errors);

}  // namespace carom::cli
