// The commands and their options as data, for completions and for Python (--help prints the same),
// and what may follow on a command line, for the shells that complete it (cmake/completion).
#pragma once

#include <string>
#include <vector>

namespace carom::cli {

struct OptionRow {
  std::vector<std::string> names;  ///< "-o", "--output"; of an argument: "SYSTEM"
  std::string value;               ///< what follows it: "N", "FILE.h5", "auto|steps"; "" : nothing
  std::string help;
};

struct CommandRow {
  std::string name;  ///< "" : the program without a command
  std::string text;  ///< what it does, one sentence
  std::vector<OptionRow> options;
  std::vector<OptionRow> arguments;  ///< words without a dash
  bool many_arguments = false;       ///< the last argument may be repeated
};

/// The program itself, then its commands in the order of --help.
std::vector<CommandRow> command_table();

/// `line`: the command line up to where TAB was typed. A line for each word that fits, with its
/// meaning after a tab; where a file is meant, one line of patterns: "*.toml *.h5".
std::string completions(const std::string& line);

}  // namespace carom::cli
