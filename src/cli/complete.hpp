// What may follow on a command line, for the shells that complete it (cmake/completion).
#pragma once

#include <string>

namespace carom::cli {

/// `line`: the command line up to where TAB was typed. A line for each word that fits, with its
/// meaning after a tab; where a file is meant, one line of patterns: "*.toml *.h5".
std::string completions(const std::string& line);

}  // namespace carom::cli
