// What was typed, as plain text.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "carom/files/system_overrides.hpp"

namespace carom::files {
class Json;
}  // namespace carom::files

namespace carom::cli {

/// A value of a sweep, as its command computes it.
struct ValueOfSweep {
  std::size_t index = 0;
  std::string system_name, system_toml;  ///< the system, which was read before
  /// Takes the report in place of standard output, with its doubts as text.
  std::function<void(const files::Json&, const std::string& doubts)> take;
};

struct Options {
  std::string command;  ///< subcommand, "" : none
  std::string line;     ///< the whole command line, for provenance
  std::string system;   ///< SYSTEM, or NAME of `carom systems`
  /// What SYSTEM holds, where a caller has its text already: `system` is then only its name.
  std::optional<std::string> system_text;
  /// `hidden_archive`: the output is aside and goes when its picture is drawn.
  bool hidden_archive = false;
  bool json = false, force = false, quiet = false, verbose = false, per_trajectory = false,
       soak = false, zeta = false, certify = false;
  std::string window;                                              ///< of fits
  std::string on, direction, points, orbits;                       ///< of carom section and returns
  std::string splitting, population, repetitions, kick, lookback;  ///< of carom escape
  std::vector<std::string> files;                                  ///< of carom merge
  std::string shard, block, checkpoint;                            ///< of ensembles
  std::string output, threads, trajectory, resume, scale;
  std::string what;                ///< of carom plot
  std::string frames, fps, trail;  ///< of carom animate
  std::string engine = "auto", isa = "auto", precision = "double", digits;
  std::string schemes, steps, tolerances, error, comparison_time;  ///< of carom compare
  std::string hits, tries;                                         ///< of carom orbit
  std::string starts;                                              ///< of carom orbit and relax
  bool saddles = false;                                            ///< of carom relax
  SystemOverrides overrides;
  std::vector<std::string> sweep;                ///< KEY=lin:FROM:TO:COUNT …
  std::shared_ptr<const ValueOfSweep> of_sweep;  ///< null: the command was typed
};

/// Reads the command line. Prints help to standard output or a complaint to standard error itself;
/// `exit` is then set to the status.
struct Parsed {
  Options options;
  std::optional<int> exit;
};
Parsed parse(int argc, char** argv);

/// Sets options of a command as if they were typed: "t_max" is --t-max. One that only other
/// commands have is set as theirs; the command does not look at it. Throws InputError for a value
/// that the command line refuses, std::invalid_argument for a name that no command has.
void set_options(Options&, const std::string& command,
                 const std::vector<std::pair<std::string, std::string>>& texts);

/// `untrusted`: trajectories that failed, energies beyond their tolerance, or a failed validation.
enum Status { done = 0, bad_input = 1, usage = 2, untrusted = 3, stopped = 130 };

}  // namespace carom::cli
