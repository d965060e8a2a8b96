// The list of integrators.
#pragma once

#include <string>

#include "files/json.hpp"

namespace carom::cli {

/// A line each, and below them where each is from.
std::string schemes_text();
files::Json schemes_json();

}  // namespace carom::cli
