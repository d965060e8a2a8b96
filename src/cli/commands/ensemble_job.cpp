#include "cli/commands/ensemble_job.hpp"

#include <fmt/format.h>

#include <vector>

#include "carom/base/error.hpp"
#include "carom/base/exact_number.hpp"
#include "cli/common.hpp"
#include "cli/loading.hpp"
#include "files/checkpoint/rank_parts.hpp"
#include "files/checkpoint/sweep_archive.hpp"
#include "files/checkpoint/work_folder.hpp"

namespace carom::cli {

Shard shard_of(const Options& options) {
  return options.shard.empty() ? Shard{} : carom::shard_of(options.shard, place_of("--shard"));
}

namespace {

// Keys that may differ between a system and what is stored of it. A step that the program chose is
// one: it may have halved it since.
std::vector<std::string> open_keys(const StoredEnsemble& stored, const LoadedSystem& asked) {
  std::vector<std::string> keys = keys_of_reports(stored);
  if (asked.system.dynamics.integrator.step_chosen &&
      system_of(stored).system.dynamics.integrator.step_chosen)
    keys.emplace_back("integrator.step");
  return keys;
}

// Loads the system that is stored, and refuses another one.
LoadedSystem loaded_of(const StoredEnsemble& stored, const Options& options) {
  const auto refuse = [&](const std::string& what) {
    throw InputError(Place{stored.file, 0, 0, ""},
                     "this is another ensemble than the stored one: " + what,
                     "the same system and options, or none");
  };
  LoadedSystem loaded = options.system.empty()
                            ? read_system(stored.system_toml, stored.file + ": /system",
                                          overrides_of_ensemble(options))
                            : load_system(options.system, overrides_of_ensemble(options));
  const std::string differs =
      difference(stored.system_toml, loaded.resolved_toml, open_keys(stored, loaded));
  if (!differs.empty() && !options.system.empty() && options.system != stored.system_name)
    refuse(
        fmt::format("the system is {}, not {}: {}", options.system, stored.system_name, differs));
  if (!differs.empty()) refuse(differs);
  if (const auto& value = options.of_sweep)
    files::refuse_other_value(value->index, value->system_toml, stored.system_toml, stored.file);
  System& system = loaded.system;
  system.name = stored.system_name;
  if (system.dynamics.integrator.step_chosen)
    system.dynamics.integrator.step = system_of(stored).system.dynamics.integrator.step;
  if (!system.run.window)
    system.run.window =
        read_system(stored.system_toml, stored.file + ": /system").system.run.window;
  loaded.resolved_toml = stored.system_toml;
  if (options.engine != "auto" && (options.engine == "steps") != stored.everywhere)
    refuse(fmt::format("--engine is {}, not {}", options.engine,
                       stored.everywhere ? "steps" : "auto"));
  choose_engine(options.engine == "auto" && stored.everywhere ? "steps" : options.engine, system);
  if (engine_of(system) != stored.engine || system.dynamics.everywhere != stored.everywhere)
    refuse(fmt::format("--engine is {}, not {}", options.engine,
                       stored.everywhere ? "steps" : "auto"));
  if (options.per_trajectory && !stored.per_trajectory) refuse("it has no --per-trajectory");
  if (!options.shard.empty() && shard_of(options) != stored.shard)
    refuse(fmt::format("--shard is {}, not {}", options.shard, text_of(stored.shard)));
  return loaded;
}

}  // namespace

template <class Result>
EnsembleJob<Result> job_to_go_on(const Options& options, Sharing sharing) {
  EnsembleJob<Result> job;
  job.output = archive_named(options.resume);
  // A complete archive is only shown.
  if (sharing != Sharing::other &&
      !(is_complete(job.output) && !files::has_work_folder(job.output))) {
    job.lock = lock_output(options, job.output);
    files::gather_parts<Result>(job.output, sharing == Sharing::first, job.lock);
  }
  job.stored = read_ensemble<Result>(job.output);
  if (!options.output.empty() && options.output != job.output)
    throw InputError(place_of("--output"), "an ensemble continues in the same archive",
                     "no -o beside --resume");
  if (!job.stored->result.complete) refuse_other_version(*job.stored);
  job.loaded = loaded_of(*job.stored, options);
  check_stored(*job.stored, job.loaded.system);
  job.shard = job.stored->shard;
  return job;
}

#define CAROM_MAKE(Result) template EnsembleJob<Result> job_to_go_on(const Options&, Sharing);
CAROM_FOR_ENSEMBLES(CAROM_MAKE)
#undef CAROM_MAKE

bool is_plain_ensemble(const Options& options) {
  return is_ensemble(options.command) && options.splitting.empty();
}

CheckpointInterval checkpoint_interval(const std::string& text) {
  const char* const option = "--checkpoint";
  const std::string in_blocks = "blocks:";
  CheckpointInterval interval;
  if (text.starts_with(in_blocks)) {
    interval.blocks = whole_number(text.substr(in_blocks.size()), option, 1);
    return interval;
  }
  try {
    interval.seconds = ExactNumber(text, place_of(option)).to_double();
  } catch (const InputError&) {
    interval.seconds = 0;  // no number: the message below
  }
  if (!(interval.seconds > 0.0 && interval.seconds < 1e9))
    throw InputError(place_of(option), fmt::format("'{}' is no time between checkpoints", text),
                     "seconds, more than 0 and less than 1e9");
  return interval;
}

}  // namespace carom::cli
