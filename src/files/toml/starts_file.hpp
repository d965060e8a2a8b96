// [initial] kind = "file": starts kept in a text file.
#pragma once

#include "files/toml/value.hpp"

namespace carom::files {

/// Turns kind = "file" into the list of the starts that the file holds, so that what is resolved
/// can be run again without it. Anything else is left alone.
void take_starts_from_file(Value& initial);

/// Sets the speeds to the lengths of the listed velocities if neither speed nor energy is given.
void take_speeds_from_starts(Value& root);

}  // namespace carom::files
