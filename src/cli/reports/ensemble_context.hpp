// What the report of an ensemble says besides the numbers.
#pragma once

#include <string>

#include "carom/io/archive.hpp"

namespace carom::cli {

struct EnsembleContext {
  std::string status;  ///< "completed", "interrupted", "incomplete"
  std::string output;  ///< archive, or ""
  Shard shard;
};

}  // namespace carom::cli
