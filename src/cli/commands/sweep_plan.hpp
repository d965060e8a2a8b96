// What --sweep asks for, read and checked before anything is computed.
#pragma once

#include <vector>

#include "cli/commands/sweep.hpp"
#include "files/checkpoint/sweep_archive.hpp"

namespace carom::cli {

/// The plan of the options. Reads the system of every value: throws InputError for one that is bad
/// input, and for a key that means nothing to the command.
files::SweepPlan plan_of_sweep(const Options&);
/// Throws InputError, with `file` as its place, where two plans differ, and says in what. Windows
/// may differ.
void refuse_another(const files::SweepPlan& stored, const files::SweepPlan& asked,
                    const std::string& file);
/// Options that are no part of a system, as the plan keeps them.
void restore_options(const files::SweepPlan&, Options&);

}  // namespace carom::cli
