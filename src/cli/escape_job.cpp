#include "cli/escape_job.hpp"

#include <fmt/format.h>

#include <utility>

#include "carom/base/error.hpp"
#include "carom/base/exact_number.hpp"
#include "cli/common.hpp"
#include "ensemble/crew.hpp"

namespace carom::cli {

namespace {

Place place_of(const char* option) { return Place{"command line", 0, 0, option}; }

Shard shard_of(const std::string& text) {
  constexpr std::uint64_t most = std::uint64_t{1} << 32;
  if (text.empty()) return {};
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos)
    throw InputError(place_of("--shard"), fmt::format("'{}' is not a part", text), "K/N: part K of N, such as 2/8");
  const Shard shard{whole_number(text.substr(0, slash), "--shard", 1), whole_number(text.substr(slash + 1), "--shard", 1)};
  if (shard.of >= most) throw InputError(place_of("--shard"), "there are too many parts", "less than 2^32");
  if (shard.k > shard.of)
    throw InputError(place_of("--shard"), fmt::format("there is no part {} of {}", shard.k, shard.of), "K from 1 to N");
  return shard;
}

EscapeJob job_to_go_on(const Options& options) {
  EscapeJob job;
  job.output = options.resume;
  if (job.output.ends_with(".part")) job.output.resize(job.output.size() - 5);
  job.stored = read_escape(job.output);
  const StoredEscape& stored = *job.stored;
  const auto refuse = [&](const std::string& what) {
    throw InputError(Place{stored.file, 0, 0, ""}, "what is asked for is not what is stored: " + what,
                     "the same system and options, or none");
  };
  if (!options.output.empty() && options.output != job.output)
    throw InputError(place_of("--output"), "an ensemble goes on in the same archive", "no -o beside --resume");
  if (!stored.result.complete) refuse_other_version(stored);
  job.loaded = options.system.empty() ? read_system(stored.system_toml, stored.file + ": /system", options.overrides)
                                      : load_system(options.system, options.overrides);
  // The name says more than the first key that differs.
  const std::string differs = difference(stored.system_toml, job.loaded.resolved_toml);
  if (!differs.empty() && !options.system.empty() && options.system != stored.system_name)
    refuse(fmt::format("the system is {}, not {}", options.system, stored.system_name));
  if (!differs.empty()) refuse(differs);
  System& system = job.loaded.system;
  system.name = stored.system_name;
  choose_engine(options.engine == "auto" && stored.everywhere ? "steps" : options.engine, system);
  if (engine_of(system) != stored.engine || system.dynamics.everywhere != stored.everywhere)
    refuse(fmt::format("--engine is {}, not {}", options.engine, stored.everywhere ? "steps" : "auto"));
  if (options.per_trajectory && !stored.per_trajectory) refuse("it has no --per-trajectory");
  job.shard = stored.shard;
  if (!options.shard.empty() && shard_of(options.shard) != stored.shard)
    refuse(fmt::format("--shard is {}, not {}", options.shard, text_of(stored.shard)));
  return job;
}

}  // namespace

EscapeJob job_of(const Options& options) {
  if (!options.resume.empty()) return job_to_go_on(options);
  EscapeJob job;
  job.output = options.output;
  job.shard = shard_of(options.shard);
  job.loaded = load_system(options.system, options.overrides);
  choose_engine(options.engine, job.loaded.system);
  return job;
}

void JobCall::make(const EscapeJob* job) {
  if (!ranks_) return;
  Ranks& ranks = *std::exchange(ranks_, nullptr);
  if (!job) return call_crew(ranks, nullptr);
  const System& system = job->loaded.system;
  const CrewJob crew_job{system.name, job->loaded.resolved_toml, system.dynamics.everywhere};
  call_crew(ranks, &crew_job);
}

std::optional<LoadedSystem> called_job(Ranks& ranks) {
  const std::optional<CrewJob> job = called_by(ranks);
  if (!job) return {};
  try {
    LoadedSystem loaded = read_system(job->toml, job->name);
    loaded.system.dynamics.everywhere = job->everywhere;
    return loaded;
  } catch (const std::exception& error) {
    Hand(ranks).end(text_of(error));
    throw;
  }
}

bool is_plain_ensemble(const Options& options) { return options.splitting.empty() && options.certify_sample.empty(); }

void refuse_parts_of_others(const Options& options) {
  if (is_plain_ensemble(options)) return;
  const char* const only = "a plain ensemble: neither --splitting nor --certify-sample";
  if (!options.resume.empty()) throw InputError(place_of("--resume"), "this cannot be continued", only);
  if (!options.shard.empty()) throw InputError(place_of("--shard"), "this cannot be parted", only);
}

double seconds_between_checkpoints(const std::string& text) {
  const double seconds = ExactNumber(text, place_of("--checkpoint")).to_double();
  if (!(seconds > 0.0 && seconds < 1e9))
    throw InputError(place_of("--checkpoint"), fmt::format("'{}' is not a time between checkpoints", text),
                     "seconds, more than 0");
  return seconds;
}

}  // namespace carom::cli
