// Archives of ensembles: written while they run, read back, gone on with, added up.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "carom/files/archive.hpp"
#include "carom/results/ensemble_result.hpp"

namespace carom {

/// The records of an ensemble's archive, in order of index; none where none were stored.
std::vector<TrajectoryRecord> read_trajectories(const std::string& file);

/// Part `k` of `of`, from 1 on.
struct Shard {
  std::uint64_t k = 1, of = 1;
  bool operator==(const Shard&) const = default;
  TrajectoryRange range(std::uint64_t trajectories) const { return shard(k, of, trajectories); }
};
std::string text_of(const Shard&);  ///< "2/8"
/// Part `k` of `of` as it is written: "2/8". Throws InputError for anything else.
Shard shard_of(const std::string& text, const Place&);

/// An ensemble as its archive holds it, or the checkpoint of one that has not ended.
struct StoredEnsemble {
  std::string file;  ///< that was read: FILE or the checkpoint in FILE.part
  std::string kind, version, system_name, system_toml, status;
  std::string engine;       ///< "events", "steps" or "auto"
  bool everywhere = false;  ///< --engine steps: integrates everything
  std::string arithmetic;   ///< fingerprint of the digits that the build computes which wrote it;
                            ///< "": it says none
  std::vector<Origin> origins;
  std::vector<std::string> merged;  ///< the files that `carom merge` added
  Shard shard;
  bool per_trajectory = false;
};
/// Its system.
LoadedSystem system_of(const StoredEnsemble&);
/// An ensemble in an archive, with its counts and sums.
template <class Result>
struct Stored : StoredEnsemble {
  Result result;
};
/// Is there an archive of this name that is complete?
bool is_complete(const std::string& file);
/// The kind of ensemble that FILE.h5 or its checkpoint holds. Throws InputError for anything else.
std::string kind_of_ensemble(const std::string& file);
/// Reads FILE.h5 or its checkpoint, whichever has more trajectories of the same ensemble; only the
/// checkpoint if FILE.h5 is anything else. Throws InputError where there is no ensemble.
template <class Result>
Stored<Result> read_ensemble(const std::string& file);
/// Throws InputError where it cannot be what this system gave: it was damaged or changed.
template <class Result>
void check_stored(const Stored<Result>&, const System&);
/// Throws InputError where another version of the program wrote it, or a build that computes other
/// digits.
void refuse_other_version(const StoredEnsemble&);
/// The first key in which two resolved systems differ: "run.seed is 2, not 1". Empty: none. `but`
/// are keys that may.
std::string difference(const std::string& toml, const std::string& other_toml,
                       const std::vector<std::string>& but = {});
/// Keys that the report of an ensemble alone asks for: they may differ in what goes on with it and
/// in its parts. A window, except for exponents, which are added up within theirs.
std::vector<std::string> keys_of_reports(const StoredEnsemble&);

/// A part of a sum.
struct EnsemblePart {
  std::string file;
  TrajectoryRanges done;
  double seconds = 0;
};
template <class Result>
struct SumOfParts : Stored<Result> {
  std::vector<EnsemblePart> parts;
};
/// The sum of parts of one ensemble, in any order the same; complete where nothing of the shard is
/// missing. One part at a time is in memory. Throws InputError where parts overlap or do not match,
/// and says in what.
template <class Result>
SumOfParts<Result> sum_of(const std::vector<std::string>& files, const Shard& shard = {});
/// Writes the sum as its ensemble's archive, in place of what there is of that name.
template <class Result>
void write_sum(const std::string& file, const LoadedSystem&, const Provenance&,
               const SumOfParts<Result>&, ArchiveLock = nullptr);

/// An ensemble's result. While the ensemble runs, its checkpoint is in the folder FILE.part: an
/// archive by itself, always whole, and the records of trajectories. When finished, FILE replaces
/// the folder.
template <class Result>
class EnsembleArchive : public EnsembleJournal<Result> {
 public:
  /// What is written; `force` replaces an archive that exists.
  struct Plan {
    bool force = false, per_trajectory = false;
    Shard shard;
    std::function<void(const std::string&)> warn;  ///< of a checkpoint that could not be written
    ArchiveLock lock = nullptr;
  };
  EnsembleArchive(const std::string& file, const LoadedSystem&, const Provenance&, const Plan&);
  /// Goes on with a stored ensemble; the plan is that of the store.
  EnsembleArchive(const std::string& file, const LoadedSystem&, const Provenance&,
                  const Stored<Result>&, const Plan&);
  EnsembleArchive(const EnsembleArchive&) = delete;
  ~EnsembleArchive() override;

  bool wants_records() const override;
  void block(TrajectoryRange, std::vector<TrajectoryRecord>&&) override;
  void mark() override;
  void save(const Result& so_far) override;
  /// Last of all: the result takes the place of the checkpoint.
  void finish(const Result&, const std::string& status);
  /// Trajectories of the checkpoint that is on the disk now.
  std::uint64_t kept() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace carom
