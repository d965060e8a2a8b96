#include "cli/common.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "base/parts.hpp"
#include "base/printable.hpp"
#include "carom/base/exact_number.hpp"
#include "carom/base/whole_number.hpp"
#include "carom/system/report_times.hpp"
#include "carom_version.hpp"
#include "cli/loading.hpp"
#include "cli/reports/aligned.hpp"
#include "files/checkpoint/work_folder.hpp"

namespace carom::cli {

using files::Json;

// In one piece, so that lines of several processes do not mix. A closed stderr is no error.
void write_message(const std::string& line) {
  std::fputs((base::printable(line, base::Lines::many) + "\n").c_str(), stderr);
}

std::uint64_t whole_number(const std::string& text, const char* option, std::uint64_t least) {
  const Place place = place_of(option);
  const std::string expected = fmt::format("a whole number of at least {}", least);
  const auto number = carom::whole_number(ExactNumber(text, place));
  if (!number)
    throw InputError(place, fmt::format("'{}' is not a whole number below 2^64", text), expected);
  if (*number < least) throw InputError(place, fmt::format("{} is too small", text), expected);
  return *number;
}

int threads_of(const Options& options) {
  if (options.threads.empty()) return 0;
  const std::uint64_t threads = whole_number(options.threads, "--threads", 1);
  if (threads > 4096)
    throw InputError(place_of("--threads"), fmt::format("{} threads are too many", threads),
                     "at most 4096");
  return static_cast<int>(threads);
}

namespace {

[[noreturn]] void refuse_name(const char* option, const std::string& value, const char* problem,
                              const std::string& expected, const std::string& nearest = {}) {
  throw InputError(place_of(option), fmt::format("'{}' {}", value, problem), expected, nearest);
}

void check_instruction_set(const Options& options) {
  if (options.isa == "auto") return;
  std::vector<std::string> here{"auto"};
  for (const InstructionSet set : available_instruction_sets()) here.emplace_back(name_of(set));
  if (std::find(here.begin(), here.end(), options.isa) == here.end())
    refuse_name("--isa", options.isa, "is not an instruction set of this machine",
                fmt::format("{}", fmt::join(here, ", ")), nearest_name(options.isa, here));
}

}  // namespace

void check_engine(const Options& options) {
  if (options.engine != "auto" && options.engine != "events" && options.engine != "steps")
    refuse_name("--engine", options.engine, "is not an engine", "auto, events or steps",
                nearest_name(options.engine, {"auto", "events", "steps"}));
  check_instruction_set(options);
}

InstructionSet instruction_set_of(const Options& options) {
  for (const InstructionSet set : available_instruction_sets())
    if (options.isa == name_of(set)) return set;
  return widest_instruction_set();
}

void follow_links(Options& options) {
  for (std::string* name : {&options.output, &options.resume}) *name = followed(*name);
  for (std::string& name : options.files) name = followed(name);
}

ArchiveLock lock_output(const Options& options, const std::string& file) {
  if (!options.of_sweep) refuse_inside(file);
  ArchiveLock lock = lock_archive(file);
  if (const std::string weakness = weakness_of(lock); !weakness.empty())
    warn(fmt::format(
        "no other process is kept from writing '{}': its file system gives no locks ({})", file,
        weakness));
  return lock;
}

ArchiveLock claim_output(const Options& options) {
  if (options.output.empty()) return nullptr;
  ArchiveLock lock = lock_output(options, options.output);
  refuse_existing(options.output, options.force);
  return lock;
}

Provenance provenance_of(const Options& options, const System& system, int threads) {
  return {options.line, engine_of(system), "baseline", threads, {}};
}

void add_common_keys(Json& json, const System& system, int threads, double seconds,
                     double cpu_seconds, const char* isa) {
  json.set("version", version);
  json.set("system", system.name);
  if (!system.title.empty()) json.set("title", system.title);
  json.set("seed", system.run.seed);
  json.set("threads", threads);
  json.set("engine", engine_of(system));
  json.set("isa", isa);
  json.set("seconds", seconds);
  json.set("cpu_seconds", cpu_seconds);
}

namespace {

double exact_share(const DecisionCounts& decisions) {
  const double all = static_cast<double>(decisions.filter) + static_cast<double>(decisions.exact);
  return all > 0.0 ? static_cast<double>(decisions.exact) / all : 0.0;
}

}  // namespace

Json decisions_json(const DecisionCounts& decisions) {
  return Json::object()
      .set("filter", decisions.filter)
      .set("exact", decisions.exact)
      .set("share", exact_share(decisions));
}

std::string decisions_text(const DecisionCounts& decisions) {
  return fmt::format("decisions beyond double precision: {} %", in_percent(exact_share(decisions)));
}

std::string lanes_text(const std::string& none, std::optional<InstructionSet> lanes,
                       const LaneEffort& effort) {
  if (!none.empty()) return folded("lanes: none: " + none) + '\n';
  const char* const set = name_of(lanes.value_or(InstructionSet::baseline));
  if (effort.steps == 0) return fmt::format("lanes: {}\n", set);
  return fmt::format("lanes: {}, {:.1f} % busy, {} % of events left to the scalar engine\n", set,
                     100.0 * effort.busy(), in_percent(effort.left()));
}

std::size_t rows_of(const Options& options) {
  return options.verbose || !options.overrides.times.empty() ? SIZE_MAX : 12;
}

void print(const std::string& text) {
  const std::string shown = base::printable(text, base::Lines::many);
  errno = 0;
  const bool ok = std::fwrite(shown.data(), 1, shown.size(), stdout) == shown.size() &&
                  std::fflush(stdout) == 0;
  if (!ok && errno == EPIPE) throw OutputClosed();
  if (!ok)
    throw InputError(fmt::format("cannot write to standard output: {}", std::strerror(errno)));
}

void warn(const std::string& text) { write_message("carom: " + text); }

std::string until(double last_time) {
  return last_time < no_last_time ? fmt::format("until t = {:.6g}", last_time)
                                  : "without a last time";
}

std::string heading(const System& system) {
  return folded(base::printable(system.title.empty() ? system.name : system.title)) + "\n";
}

std::vector<double> numbers_of(const std::string& text, const char* option, const char* what,
                               const char* expected) {
  const Place place = place_of(option);
  const bool grid = text.find(':') != std::string::npos;
  const std::vector<std::string> parts = base::parts_of(text, grid ? ':' : ',');
  const auto number = [&](const std::string& part) { return ExactNumber(part, place).to_double(); };
  std::vector<double> numbers;
  if (!grid) {
    for (const std::string& part : parts) numbers.push_back(number(part));
    return numbers;
  }
  const bool log = parts[0] == "log";
  if (parts.size() != 4 || (!log && parts[0] != "lin"))
    throw InputError(place, fmt::format("cannot read the {} '{}'", what, text), expected);
  const double first = number(parts[1]), last = number(parts[2]);
  const std::uint64_t count = whole_number(parts[3], option, 2);
  if (!(first < last) || (log && !(first > 0.0)) || count > 1'000'000)
    throw InputError(place, fmt::format("cannot read the {} '{}'", what, text),
                     fmt::format("from < to, at most 1e6 {}", what));
  return spaced(first, last, count, log);
}

}  // namespace carom::cli
