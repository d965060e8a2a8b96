// The list of integrators.
#pragma once

#include <string>

#include "io/json.hpp"

namespace carom::cli {

/// A line each.
std::string schemes_text();
io::Json schemes_json();

}  // namespace carom::cli
