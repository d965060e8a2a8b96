// The system that a command is asked for.
#pragma once

#include <string>

#include "carom/files/system_file.hpp"
#include "carom/system/system.hpp"
#include "cli/options.hpp"

namespace carom::cli {

/// The system that is asked for: of a sweep that of its value.
LoadedSystem load(const Options&, const SystemOverrides&);
LoadedSystem load_typed(const Options&);  ///< with what was typed
/// Sets in the system what --engine asks for: "auto", "events" (refused where forces act) or
/// "steps".
void choose_engine(const std::string& engine, System&);
/// What moves the particles: "events" (exact flights), "steps" (integration) or "auto" (both).
std::string engine_of(const System&);
/// A doubt about an ensemble's errors: "" unless its trajectories repeat the starts that are
/// listed.
std::string repeated_starts(const System&);
/// Options that are keys of an ensemble's system.
SystemOverrides overrides_of_ensemble(const Options&);
/// The system of a new ensemble.
LoadedSystem load_ensemble(const Options&);

}  // namespace carom::cli
