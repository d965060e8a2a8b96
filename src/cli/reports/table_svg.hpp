// A drawing of a table: walls, holes, names.
#pragma once

#include <string>

#include "carom/table/table.hpp"

namespace carom::cli {

/// A lattice without walls is drawn as its cell. Throws InputError for a plane without walls.
std::string table_svg(const Table&, const std::string& title);

}  // namespace carom::cli
