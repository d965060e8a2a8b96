// What the report of an ensemble says besides the numbers.
#pragma once

#include <string>

#include "carom/ensemble/parts.hpp"
#include "carom/ensemble/system.hpp"
#include "carom/io/archive.hpp"
#include "io/json.hpp"

namespace carom::cli {

struct EnsembleContext {
  std::string status;  ///< "completed", "interrupted", "incomplete"
  std::string output;  ///< archive, or ""
  Shard shard;
};

/// The keys with which the report of every ensemble begins.
Json ensemble_json(const System&, const EnsembleResult&, const EnsembleContext&);

}  // namespace carom::cli
