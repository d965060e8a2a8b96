// Text files of numbers: a row in each line.
#pragma once

#include <string>

#include "files/toml/value.hpp"

namespace carom::files {

/// Paths are relative to the system file's folder, those of the command line to the present one.
std::string located(const Value& path);

/// The numbers of a line, parted by blanks or commas; # begins a comment. Each keeps its place.
Value numbers_of_line(std::string line, const Place& place);

/// The rows that a file holds, each with at least `least` and at most `most` numbers. `row` names a
/// row ("start"), `numbers` its numbers ("x y vx vy"), for messages.
struct Row {
  const char *name, *numbers;
  std::size_t least, most;
};
Value rows_of_file(const std::string& name, const Place& key, const Row& row);

}  // namespace carom::files
