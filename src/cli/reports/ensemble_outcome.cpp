#include "cli/reports/ensemble_outcome.hpp"

#include <utility>

#include "cli/common.hpp"
#include "cli/loading.hpp"

namespace carom::cli {

template <class Result>
void OutcomeOf<Result>::save(const std::string& file, bool force, const std::atomic<bool>&) const {
  typename EnsembleArchive<Result>::Plan plan;
  plan.force = force;
  plan.per_trajectory = records.has_value();
  refuse_existing(file, force);
  EnsembleArchive<Result> archive(followed(file), loaded->loaded,
                                  provenance_of(loaded->options, system(), result.threads), plan);
  if (records) archive.block({0, system().run.trajectories}, std::vector(*records));
  archive.mark();
  archive.finish(result, status);
}
#define CAROM_MAKE(Result) template class OutcomeOf<Result>;
CAROM_FOR_ENSEMBLES(CAROM_MAKE)
#undef CAROM_MAKE

namespace {

template <class Result>
OutcomePointer opened(const std::string& file) {
  Stored<Result> stored = read_ensemble<Result>(file);
  auto outcome = std::make_shared<OutcomeOf<Result>>(std::make_shared<Loaded>());
  outcome->loaded->loaded = system_of(stored);
  outcome->loaded->options.command = stored.kind;
  choose_engine(stored.everywhere ? "steps" : "auto", outcome->loaded->loaded.system);
  check_stored(stored, outcome->system());
  outcome->status = stored.status;
  outcome->result = std::move(stored.result);
  if (stored.per_trajectory && stored.file == file)
    outcome->records = read_trajectories(stored.file);
  return outcome;
}

}  // namespace

OutcomePointer open_ensemble(const std::string& file) {
  OutcomePointer outcome;
  for_kind(kind_of_archive(file),
           [&]<class Result>(std::type_identity<Result>) { outcome = opened<Result>(file); });
  return outcome;
}

}  // namespace carom::cli
