// carom validate as a page of HTML that needs no other file.
#pragma once

#include <string>

#include "cli/commands/validate.hpp"

namespace carom::cli {

/// Every case with value, error, expected value and distance; drawings of the distances in units of
/// the standard error. `command` is the command line as typed.
std::string validation_page(const Validation&, const std::string& command);

}  // namespace carom::cli
