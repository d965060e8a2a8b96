// What the subcommands share.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <optional>
#include <string>
#include <vector>

#include "base/counted.hpp"
#include "carom/base/error.hpp"
#include "carom/events/decisions.hpp"
#include "carom/files/archive.hpp"
#include "carom/files/system_file.hpp"
#include "carom/lanes/instruction_set.hpp"
#include "carom/lanes/lane_effort.hpp"
#include "carom/system/system.hpp"
#include "cli/options.hpp"
#include "files/json.hpp"

namespace carom::cli {

/// A whole number written in any way ("1e3"), at least `least`. Throws InputError naming the
/// option.
std::uint64_t whole_number(const std::string& text, const char* option, std::uint64_t least);
/// Threads asked for; 0: all.
int threads_of(const Options&);
/// Throws InputError for engines and instruction sets that this version does not have. Where the
/// lanes are chosen otherwise, a warning says that --isa changed nothing.
void check_engine(const Options&);
/// What --isa asks for: the widest of this machine, or the one named.
InstructionSet instruction_set_of(const Options&);
/// Replaces links by the names of the files that they lead to.
void follow_links(Options&);
/// lock_archive; where others are not kept away, a warning says so.
ArchiveLock lock_output(const Options&, const std::string& file);
/// The lock of the file that -o names, which must not exist but with --force; null without -o.
ArchiveLock claim_output(const Options&);
Provenance provenance_of(const Options&, const System&, int threads);

/// Adds version, system, title if there is one, seed, threads, engine, isa, seconds, cpu_seconds.
void add_common_keys(files::Json& json, const System& system, int threads, double seconds,
                     double cpu_seconds, const char* isa = "baseline");
/// {filter, exact, share}: how many decisions each stage took, and the share that left the filter.
files::Json decisions_json(const DecisionCounts&);
/// "decisions beyond double precision: 0.0001 %".
std::string decisions_text(const DecisionCounts&);
/// "lanes: " and what becomes of them: `none`, why nothing flies in lanes, or if that is "" the
/// instruction set and how busy they were.
std::string lanes_text(const std::string& none, std::optional<InstructionSet> lanes,
                       const LaneEffort& effort = {});
/// The reader of standard output has closed it, as `head` does.
struct OutputClosed : std::exception {};
/// Most rows of a printed table of times: 12; all with --verbose or --times.
std::size_t rows_of(const Options&);
/// Writes to standard output. Throws OutputClosed, or InputError where it cannot be written
/// otherwise.
void print(const std::string& text);
/// The archive that a report names: none where it goes when its picture is drawn, or into that of
/// a sweep.
inline std::string named_archive(const Options& options, const std::string& output) {
  return options.hidden_archive || options.of_sweep ? std::string() : output;
}
/// Prints a report as JSON or as text; that of a value goes to its sweep. `json` and `text` are
/// functions that make them, `doubts` is why the result cannot be trusted.
void print_report(const Options& options, const auto& json, const auto& text,
                  const std::string& doubts = {}) {
  if (options.of_sweep)
    options.of_sweep->take(json(), doubts);
  else
    print(options.json ? json().text() + "\n" : text());
}
/// A line on standard error. Where it cannot be written it is lost, and nothing else.
void write_message(const std::string& line);
/// A line on standard error: "carom: text".
void warn(const std::string& text);
/// Where an error in an option is.
inline Place place_of(const char* option) { return {"command line", 0, 0, option}; }

using base::counted;
using base::grouped;
/// "until t = 20", or "without a last time".
std::string until(double last_time);
/// The first line of a report: the system's title, or its name.
std::string heading(const System&);

/// Reads "a,b,c", "lin:from:to:count" or "log:from:to:count" (from < to), at most 10^6 of them.
/// Throws InputError naming the option, what it takes ("levels"), and where it is no such list
/// `expected`.
std::vector<double> numbers_of(
    const std::string& text, const char* option, const char* what,
    const char* expected = "a,b,c or log:from:to:count or lin:from:to:count");

}  // namespace carom::cli
