// Texts about the program that are made from its table of commands when it is built.
#pragma once

#include <string>
#include <vector>

#include "cli/command_table.hpp"

namespace carom::cli::manual {

/// carom.1, in the macros of man(7).
std::string man_page(const std::vector<CommandRow>& table);
/// What bash reads when carom is to be completed.
std::string bash_completion(const std::vector<CommandRow>& table);
/// _carom, for zsh.
std::string zsh_completion(const std::vector<CommandRow>& table);

}  // namespace carom::cli::manual
