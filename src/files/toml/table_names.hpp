// Walls and holes of a table by their names.
#pragma once

#include <string>

#include "carom/base/error.hpp"
#include "carom/table/table.hpp"

namespace carom::files {

/// Index of the wall or hole; an InputError at the place lists the names there are.
int wall_named(const Table& table, const std::string& name, const Place& place);
int hole_named(const Table& table, const std::string& name, const Place& place);

}  // namespace carom::files
