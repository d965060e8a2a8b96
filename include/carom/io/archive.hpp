// Archives (HDF5): what a run or an ensemble leaves on disk. docs/guide/archive.md is the schema.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "carom/ensemble/kinds.hpp"
#include "carom/ensemble/run_rows.hpp"
#include "carom/ensemble/section_run.hpp"
#include "carom/ensemble/single_run.hpp"
#include "carom/ensemble/trajectory_ranges.hpp"
#include "carom/io/system_file.hpp"

namespace carom::io {
class WorkFolder;
}  // namespace carom::io

namespace carom {

/// Once, before anything else happens in the program.
void prepare_archives();

/// Throws InputError where `file` exists and `force` is not set, and where it is no file: a folder,
/// a device, a pipe.
void refuse_existing(const std::string& file, bool force);
/// Is there an ensemble of this name that has not ended?
bool has_checkpoint(const std::string& file);

/// For the process that holds the lock of `file`: removes its checkpoint, if it has one, and the
/// records that this names.
void remove_checkpoint(const std::string& file);
/// The file behind a name: symbolic links are followed, to a file that is not there yet, too, so
/// that what stands beside an archive stands beside the file and not beside the link. Throws
/// InputError where links lead round.
std::string followed(const std::string& name);
/// The archive that a user means: FILE for the name of its folder FILE.part.
std::string archive_named(const std::string& name);
/// Throws InputError where FILE is in the folder in which another archive is made.
void refuse_inside(const std::string& file);

/// As long as it lives, no other process writes the archive. It holds the folder FILE.part, in
/// which FILE is made.
using ArchiveLock = std::shared_ptr<io::WorkFolder>;
/// Throws InputError where another process writes it, where it is no file, and where FILE.part is
/// something else. Archives take their lock themselves, unless they are given one that was taken
/// before something was read.
ArchiveLock lock_archive(const std::string& file);
/// Why the file system gives no lock ("No locks available"), so that other processes are not kept
/// away; "" if it does.
std::string weakness_of(const ArchiveLock&);

/// The run that made a part of a result.
struct Origin {
  std::string command, version, date;
};

/// Where a result comes from. Everything else of /provenance is known to the archive.
struct Provenance {
  std::string command;  ///< as typed
  std::string engine, isa;
  int threads = 1;
  std::vector<Origin> before;  ///< of the parts that came before
};

/// A run while it happens: hits and samples go to the file in batches, which readers can follow
/// (HDF5's SWMR mode). A file that is not finished is removed, unless the process is killed: then
/// it stays readable, with the attribute `complete` still 0.
class RunArchive : public Observer {
 public:
  static std::unique_ptr<RunArchive> create(const std::string& file, const LoadedSystem&,
                                            const Provenance&, bool force,
                                            std::optional<std::uint64_t> trajectory = 0,
                                            ArchiveLock = nullptr);
  /// Goes on with the run stored in `source`: works on a copy aside, which becomes `target`
  /// (often the source itself) when finished.
  static std::unique_ptr<RunArchive> extend(const std::string& source, const std::string& target,
                                            const LoadedSystem&, const Provenance&, bool force,
                                            ArchiveLock = nullptr);
  ~RunArchive() override;

  /// Before anything else.
  void start(const std::vector<SampleRow>&);
  void hit(const HitEvent&) override;
  /// The same of what was kept as rows. Energies are rows only where they are wanted.
  void append(const HitRow&);
  void append(const ContactRow&);
  void append(const SampleRow&);
  void append(const EnergyRow&);
  void contact(const ContactEvent&) override;
  void sample(int particle, Time, const State&) override;
  /// False where the sum over all pairs was interrupted: nothing of this sample is stored.
  bool sampled(Time) override;
  /// Asked while energies are summed, which takes seconds for thousands of particles. True: stop.
  void listen(std::function<bool()> interrupted);
  void finish(const SingleRunResult&, const std::string& status);

 private:
  void append_hits();

  class Implementation;
  explicit RunArchive(std::unique_ptr<Implementation>);
  std::unique_ptr<Implementation> implementation_;
};

/// A run as its archive holds it.
struct StoredRun {
  std::string system_name, system_toml, status;
  std::string engine;  ///< "events", "steps" or "auto"
  std::vector<ParticleProgress> particles;
  StepCounts steps;
  Evaluations evaluations;
  double seconds = 0.0, cpu_seconds = 0.0;
  std::optional<std::uint64_t> trajectory;  ///< none: an earlier build did not store it
};
/// Throws InputError for anything but the archive of a finished or interrupted run.
StoredRun read_run(const std::string& file);

/// The rows of a run's archive. Throw InputError for anything else.
std::vector<HitRow> read_hits(const std::string& file);
std::vector<SampleRow> read_samples(const std::string& file);
/// The starts, a row a particle; none in archives of earlier builds.
std::vector<SampleRow> read_starts(const std::string& file);
/// None where the archive has no such group: no hard discs; no forces and no hard discs.
std::vector<ContactRow> read_contacts(const std::string& file);
std::vector<EnergyRow> read_energies(const std::string& file);

/// The records of an ensemble's archive, in order of index; none where none were stored.
std::vector<TrajectoryRecord> read_trajectories(const std::string& file);

/// A section as its archive holds it; times, decisions and steps are not among it.
struct StoredSection {
  std::string system_name, system_toml, engine;
  SectionResult result;
  std::vector<SectionPoint> points;
};
/// Throws InputError for anything but the archive of a section.
StoredSection read_section(const std::string& file);

/// What an archive holds: "run", "escape", "diffusion", "section", … Throws InputError for anything
/// else.
std::string kind_of_archive(const std::string& file);

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
/// in its parts. A window, but for exponents, which are added up within theirs.
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
#define CAROM_MADE_ELSEWHERE(Result) extern template class EnsembleArchive<Result>;
CAROM_FOR_ENSEMBLES(CAROM_MADE_ELSEWHERE)
#undef CAROM_MADE_ELSEWHERE

/// The points of a section, orbit after orbit; written aside, and renamed when finished.
class SectionArchive {
 public:
  SectionArchive(const std::string& file, const LoadedSystem&, const Provenance&, bool force,
                 ArchiveLock = nullptr);
  SectionArchive(const SectionArchive&) = delete;
  ~SectionArchive();

  void append(const std::vector<SectionPoint>&);
  void finish(const SectionResult&, const std::string& status);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace carom
