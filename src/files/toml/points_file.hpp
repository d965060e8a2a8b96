// [table] path: discs and corners kept in a text file.
#pragma once

#include "files/toml/value.hpp"

namespace carom::files {

/// Replaces the `path` of discs by centers (and radii, where the file has them), that of a polygon
/// by points, so that what is resolved can be run again without the file. Anything else is left
/// alone.
void take_points_from_file(Value& table);

}  // namespace carom::files
