// The decay of a survival probability for machines and for people.
#pragma once

#include <string>

#include "carom/ensemble/escape.hpp"
#include "io/json.hpp"

namespace carom::cli {

io::Json decay_json(const DecayFit&);
std::string decay_text(const DecayFit&);

}  // namespace carom::cli
