// Changes a system file's tree by --set and the other options.
#pragma once

#include <string>

#include "carom/files/system_file.hpp"
#include "files/toml/value.hpp"

namespace carom::files {

/// The file of places on the command line.
inline constexpr const char* command_line_file = "command line";

void apply(const SystemOverrides& overrides, Value& root);

/// Sets the value at a path such as "table.hole[0].width"; missing sections are made, an index one
/// past the end appends.
void set_path(Value& root, const std::string& path, Value value);

/// Halves the step of a system that has one, in its resolved TOML, too.
void halve_step(LoadedSystem&);

}  // namespace carom::files
