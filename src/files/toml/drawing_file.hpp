// `path` of a table with the shape svg: a drawing in a file.
#pragma once

#include "files/toml/value.hpp"

namespace carom::files {

/// Replaces the shape svg by a path, whose loop is the outermost curve of the drawing, and by
/// obstacles, which are the others; what is resolved can be run again without the file. Any other
/// shape is left alone.
void take_drawing(Value& table);

}  // namespace carom::files
