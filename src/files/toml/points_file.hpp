// `path` of [table] and [[table.obstacle]]: discs and corners kept in a text file.
#pragma once

#include <string>

#include "files/toml/value.hpp"

namespace carom::files {

/// Replaces the `path` of discs by centers (and radii, where the file has them), that of a polygon
/// or a spline by points, so that what is resolved can be run again without the file. Anything else
/// is left alone.
void take_points_from_file(Value& table, const std::string& section);

}  // namespace carom::files
