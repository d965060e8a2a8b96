// Holes as they are named: one that is stored in two pieces is one.
#pragma once

#include <string>
#include <vector>

#include "carom/table/table.hpp"

namespace carom {

/// A hole across the parameter 0 of a closed wall is stored as two of one name, side by side. The
/// names, each once.
std::vector<std::string> hole_names(const Table&);
/// For each of Table::holes the index of its name.
std::vector<int> hole_numbers(const Table&);

}  // namespace carom
