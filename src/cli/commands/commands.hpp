// The subcommands; each returns the exit status.
#pragma once

#include "carom/files/system_file.hpp"
#include "cli/options.hpp"

namespace carom::cli {

int systems(const Options&);
int table(const Options&);
int run(const Options&);
int escape(const Options&);
/// Of any kind, by the name of the command.
int ensemble(const Options&);
int splitting(const Options&);
int merge(const Options&);
int section(const Options&);
int relax(const Options&);
int compare(const Options&);
int schemes(const Options&);
int orbit(const Options&);
int validate(const Options&);
int plot(const Options&);
int animate(const Options&);
int page(const Options&);

/// Throws InputError for options of `escape` that another one gives a meaning, or takes it away.
void check_escape_options(const Options&);

/// The system that a command would compute, from its options.
LoadedSystem system_of_command(const Options&);
LoadedSystem system_of_run(const Options&);
LoadedSystem system_of_section(const Options&);
LoadedSystem system_of_compare(const Options&);

}  // namespace carom::cli
