// The options that one subcommand of the program takes.
#pragma once

#include <CLI/App.hpp>

#include <string>
#include <vector>

#include "cli/options.hpp"

namespace carom::cli {

inline constexpr const char* times_help =
    "Report times: a,b,c or log:from:to:count or lin:from:to:count";

// The options of one subcommand, all of them text: CLI11 itself would read -5 as 2^64 - 5.
class Command {
 public:
  /// `only`: the one command that gets its options; null: each does.
  Command(CLI::App& app, Options& options, const std::string* only, const char* group,
          const char* name, const char* text, const char* details)
      : app_(app.add_subcommand(name, text)->group(group)),
        options_(options),
        named_alone_(only != nullptr && *only != name) {
    if (named_alone_) return;
    app_->footer(details);
    flag("--json", options_.json, "Print one JSON object and nothing else");
    flag("--quiet", options_.quiet, "No progress on standard error");
  }

  Command& text(const char* name, std::string& value, const char* type, const char* help) {
    if (named_alone_) return *this;
    // A value of no characters would be dropped without a word.
    app_->add_option(name, value, help)->type_name(type)->check([name](const std::string& typed) {
      return typed.empty() ? std::string(name) + " needs a value" : std::string();
    });
    return *this;
  }
  /// An option of tests, which no help shows.
  Command& for_tests(const char* name, std::string& value) {
    if (named_alone_) return *this;
    app_->add_option(name, value)->group("");
    return *this;
  }
  Command& flag(const char* name, bool& value, const char* help) {
    if (named_alone_) return *this;
    app_->add_flag(name, value, help)->disable_flag_override();
    return *this;
  }
  /// A flag that sets a key of the system.
  Command& sets(const char* name, const char* key, const char* value, const char* help) {
    if (named_alone_) return *this;
    SystemOverrides& o = options_.overrides;
    app_->add_flag_callback(
            name, [&o, key, value] { o.set.emplace_back(key, value); }, help)
        ->disable_flag_override();
    return *this;
  }
  Command& system(const char* name, const char* help) {
    if (named_alone_) return *this;
    app_->add_option(name, options_.system, help);
    return *this;
  }
  Command& files(const char* name, const char* help) {
    if (named_alone_) return *this;
    app_->add_option(name, options_.files, help);
    return *this;
  }
  Command& settings() {
    if (named_alone_) return *this;
    SystemOverrides& o = options_.overrides;
    app_->add_option_function<std::vector<std::string>>(
            "--set",
            [&o](const std::vector<std::string>& typed) {
              for (const std::string& one : typed) {
                const std::size_t equals = one.find('=');
                if (equals == 0 || equals == std::string::npos)
                  throw CLI::ValidationError("--set", "'" + one + "' is not path.to.key=value");
                o.set.emplace_back(one.substr(0, equals), one.substr(equals + 1));
              }
            },
            "Change a key of the system; may be repeated")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false)
        ->take_all();
    return sets("--closed", "table.hole", "[]", "Without the holes");
  }
  Command& free_paths() {
    return sets("--free-paths", "run.free_paths", "true",
                "Count the lengths of flights, between hits and from the start");
  }
  Command& spectrum() {
    return sets("--spectrum", "run.spectrum", "true",
                "All exponents of all particles together, and their entropy");
  }
  Command& output(const char* type, const char* help) {
    text("-o,--output", options_.output, type, help);
    return flag("--force", options_.force, "Replace an output file that exists");
  }
  /// A command that can be repeated for values of a key.
  Command& sweep() {
    if (named_alone_) return *this;
    app_->add_option("--sweep", options_.sweep,
                     "Values of a key of the system, one row for each: KEY=lin:FROM:TO:COUNT, "
                     "log:FROM:TO:COUNT or list:a,b,c; twice: a plane")
        ->type_name("KEY=VALUES")
        ->allow_extra_args(false)
        ->take_all();
    return *this;
  }
  /// Of a command of which only a sweep can go on.
  Command& sweep_that_goes_on() {
    sweep();
    return text("--resume", options_.resume, "FILE.h5",
                "Continue a stored sweep instead of SYSTEM");
  }
  /// What changes the particles' motion.
  Command& motion() {
    SystemOverrides& o = options_.overrides;
    text("--seed", o.seed, "N", "Seed of the random numbers");
    text("--t-max", o.t_max, "T", "Last time");
    text("--collisions", o.collisions, "N", "Largest number of collisions of a trajectory");
    text("--position", o.position, "X,Y", "Start, in exact numbers: 1/10,-1/5");
    text("--velocity", o.velocity, "U,V",
         "Velocity of the start; only its direction counts if a speed is set");
    return text("--engine", options_.engine, "auto|events|steps", "What moves the particles");
  }
  Command& threads() { return text("--threads", options_.threads, "N", "Threads (default: all)"); }
  Command& verbose() {
    return flag("--verbose", options_.verbose,
                "All rows of tables, the effort of decisions and lanes, the digest");
  }
  Command& ensemble(bool reports_times = true) {
    SystemOverrides& o = options_.overrides;
    if (reports_times) text("--times", o.times, "TIMES", times_help);
    text("--trajectories", o.trajectories, "N", "Size of the ensemble (1e6 is a number)");
    threads();
    return text("--isa", options_.isa, "auto|baseline|avx2|avx512", "Instruction set of lanes");
  }
  /// Options of ensembles that can be continued, divided and shared between processes.
  Command& parts() {
    text("--resume", options_.resume, "FILE.h5",
         "Continue a stored ensemble; SYSTEM may be left out");
    text("--checkpoint", options_.checkpoint, "SECONDS",
         "Time between checkpoints of an archive (default 10 s)");
    text("--shard", options_.shard, "K/N", "Only part K (from 1) of N parts of the trajectories");
    return for_tests("--block", options_.block);
  }

 private:
  CLI::App* app_;
  Options& options_;
  bool named_alone_;
};

/// Each command with its options, which go to `options`; of the others than `only`, the names.
void define_commands(CLI::App&, Options& options, const std::string* only = nullptr);

}  // namespace carom::cli
