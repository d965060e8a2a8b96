// By which measure the starts of an ensemble are distributed.
#pragma once

#include <string>

#include "carom/system/system.hpp"
#include "files/json.hpp"

namespace carom::cli {

/// Whether they are stationary for the flow, and why not.
files::Json starts_json(const System&);
/// What is drawn in place of starts of the map (starts_of_the_map).
std::string drawn_in_place(const System&);
/// Why correlations are not those of the flow, as a phrase; "" where they are.
std::string correlation_note(const System&);

}  // namespace carom::cli
