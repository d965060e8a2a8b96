// What runs in balls and in plain numbers of many bits share.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cli/common.hpp"

namespace carom::cli {

/// The system of a run that starts from exact numbers. Throws InputError for what only doubles follow.
LoadedSystem load_exact_run(const Options&);
/// Throws InputError for a system whose motion only doubles follow.
void check_form(const System&, const char* option);
/// A start that was drawn: its doubles, taken exactly.
ExactStart exact_start(const State&);

/// "" before the first hit.
std::string wall_of(const System&, int wall);

/// How an orbit ended, with all its decimals.
struct PrintedEnd {
  std::string status;
  std::uint64_t collisions = 0;
  int wall = -1, hole = -1;
  geometry::Cell cell;
  std::string t, x, y, vx, vy;
  std::string reason;              ///< "" where the status says it all
  std::vector<std::string> notes;  ///< lines of the report, beside the status
};
/// The keys that every such run has; its own follow.
Json end_json(const System&, const PrintedEnd&, double seconds, double cpu_seconds);
/// The lines that every such run prints first.
std::string end_text(const System&, const PrintedEnd&);

/// Was a velocity that somebody wrote taken as a direction?
bool says_rescaled(const System&, bool rescaled);

/// carom run --precision BITS.
int run_in_plain_numbers(const Options&);

}  // namespace carom::cli
