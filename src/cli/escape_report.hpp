// The result of an ensemble for machines and for people.
#pragma once

#include <string>

#include "carom/ensemble/escape.hpp"
#include "io/json.hpp"

namespace carom::cli {

Json escape_json(const System&, const EscapeResult&, const std::string& status, const std::string& output);
std::string escape_text(const System&, const EscapeResult&, const std::string& output);

}  // namespace carom::cli
