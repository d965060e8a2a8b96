// The result of an ensemble for machines and for people.
#pragma once

#include <string>

#include "carom/ensemble/escape.hpp"
#include "carom/io/archive.hpp"
#include "io/json.hpp"

namespace carom::cli {

/// What a report says besides the numbers.
struct EscapeContext {
  std::string status;  ///< "completed", "interrupted", "incomplete"
  std::string output;  ///< archive, or ""
  Shard shard;
};
Json escape_json(const System&, const EscapeResult&, const EscapeContext&);
std::string escape_text(const System&, const EscapeResult&, const EscapeContext&);

}  // namespace carom::cli
