// --sweep: a command for each of many values of a key, or for each point of a plane of two. What it
// asks for is read and checked before anything is computed (sweep_plan.cpp).
#pragma once

#include <string>

#include "cli/options.hpp"
#include "cli/reports/sweep_report.hpp"
#include "files/checkpoint/sweep_archive.hpp"

namespace carom::cli {

/// A command that can be swept. What it prints goes through print_report, the system that it
/// computes comes from load; system_of_command gives the same one without computing anything.
using SweptCommand = int (*)(const Options&);

/// Is a sweep asked for, or one to go on with?
bool is_sweep(const Options&);
/// Computes value after value, each as the command with --set KEY=VALUE does: with the same seed,
/// the same digest, its own checkpoints, shared among the ranks. Returns the exit status.
int sweep(const Options&, SweptCommand);

/// Prints what was computed; `file` is its archive, or "".
void print_sweep(const Options&, SweepResult&, const std::string& file);
/// Makes FILE of FILE.part.
void keep_sweep(const Options&, const SweepResult&, const std::string& file,
                const std::vector<Origin>& before);
/// The same where there is a file; prints the result.
void end_sweep(const Options&, SweepResult&, const std::string& file,
               const std::vector<Origin>& before);

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
