#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <optional>
#include <utility>

#include "carom/base/error.hpp"
#include "carom/files/ensembles.hpp"
#include "carom/starts/injection.hpp"
#include "engines/arithmetic.hpp"
#include "files/checkpoint/ensemble_columns.hpp"
#include "files/checkpoint/ensemble_files.hpp"
#include "files/checkpoint/record_log.hpp"
#include "files/hdf5/archive_file.hpp"

namespace carom {

using namespace files;
using hdf5::Handle;

namespace {

// A full disk may get room again; after this many failed checkpoints in a row the run ends.
constexpr int most_failures = 6;

// The records of a piece are those of its trajectories, each once: what was read from the disk may
// be anything.
void check_records(const RecordLog::Piece& piece, const std::vector<TrajectoryRecord>& records,
                   std::optional<std::uint64_t>& before, const System& system,
                   const std::string& target) {
  const std::uint64_t first = particle_index(system, piece.first, 0),
                      end = particle_index(system, piece.last, 0);
  for (const TrajectoryRecord& record : records) {
    const bool in_order = !before || record.index > *before;
    if (!in_order || record.index < first || record.index - first >= end - first)
      damaged(records_of(target),
              fmt::format("a record of the trajectories {} to {} was changed: its index is {}",
                          piece.first, piece.last - 1, record.index));
    before = record.index;
  }
}

}  // namespace

template <class Result>
class EnsembleArchive<Result>::Implementation {
 public:
  Implementation(const std::string& path, const LoadedSystem& system, const Provenance& provenance,
                 const Plan& the_plan)
      : target(path), loaded(system), origin(provenance), plan(the_plan) {}
  ~Implementation() {
    if (saved && !finished && kept == 0) std::remove(checkpoint_of(target).c_str());
    if (log) log->keep(kept > 0);
  }

  void write(const Result& result, const std::string& status, bool last);

  std::string target;
  LoadedSystem loaded;
  Provenance origin;
  std::vector<std::string> merged;  // into what is gone on with
  Plan plan;                        // first of those that let go of files: its lock is the last
  std::optional<RecordLog> log;
  std::uint64_t kept = 0;
  std::optional<InputError> unwritten;  // records that belong to the next checkpoint
  bool saved = false, finished = false;
  int failures = 0;
};

void files::write_parts(const ArchiveFile& file, const EnsembleResult& result, const Shard& shard,
                        bool everywhere, const std::string& arithmetic) {
  const Handle provenance = file.open_group("provenance");
  hdf5::write_attribute(provenance.get(), "shard", text_of(shard), file.name());
  hdf5::write_attribute(provenance.get(), "everywhere", std::int64_t{everywhere}, file.name());
  if (!arithmetic.empty())
    hdf5::write_attribute(provenance.get(), arithmetic_key, std::string_view(arithmetic),
                          file.name());
  file.write_seconds({result.seconds, result.cpu_seconds});
  file.add_decisions(result.decisions);
  write_done(file, result);
}

// Aside, synced, renamed: under its name a file is whole or is not there.
template <class Result>
void EnsembleArchive<Result>::Implementation::write(const Result& result, const std::string& status,
                                                    bool last) {
  if (unwritten) throw *unwritten;  // what is counted and what is recorded would differ
  ArchiveFile file = ArchiveFile::create(aside_of(target), target);
  Provenance now = origin;
  now.threads = result.threads;
  if (result.lanes) now.isa = name_of(*result.lanes);
  file.write_head(kind_of(result), loaded, now);
  write_parts(file, result, plan.shard, loaded.system.dynamics.everywhere,
              engines::arithmetic_fingerprint());
  if (!merged.empty())
    hdf5::write_attribute(file.open_group("provenance").get(), "merged", merged, target);
  write_counts(file, result, loaded.system);
  if (log && last) {
    auto rows = create_records<Result>(file, loaded.system);
    std::optional<std::uint64_t> before;
    log->read([&](const RecordLog::Piece& piece, const std::vector<TrajectoryRecord>& records) {
      check_records(piece, records, before, loaded.system, target);
      for (const TrajectoryRecord& record : records) rows.add(record);
    });
    rows.close();
  } else if (log) {
    write_pieces(file, log->sync());
  }
  file.set_status(status, last && result.complete);
  file.keep_as(last ? target : checkpoint_of(target));
}

template <class Result>
EnsembleArchive<Result>::EnsembleArchive(const std::string& file, const LoadedSystem& loaded,
                                         const Provenance& origin, const Plan& plan) {
  Plan locked = plan;
  if (!locked.lock) locked.lock = lock_archive(file);
  refuse_existing(file, plan.force);
  give_up_checkpoint(file);
  implementation_ = std::make_unique<Implementation>(file, loaded, origin, locked);
  if (plan.per_trajectory) implementation_->log.emplace(records_of(file), file);
}

template <class Result>
EnsembleArchive<Result>::EnsembleArchive(const std::string& file, const LoadedSystem& loaded,
                                         const Provenance& origin, const Stored<Result>& stored,
                                         const Plan& plan) {
  Plan locked = plan;
  if (!locked.lock) locked.lock = lock_archive(file);
  const bool goes_on = stored.file == checkpoint_of(file);
  if (!goes_on) remove_checkpoint(file);
  implementation_ = std::make_unique<Implementation>(file, loaded, origin, locked);
  Implementation& a = *implementation_;
  a.merged = stored.merged;
  a.plan.per_trajectory = stored.per_trajectory;
  a.plan.shard = stored.shard;
  if (goes_on) a.kept = stored.result.done.size();
  if (!stored.per_trajectory) return;
  if (goes_on) {
    a.log.emplace(records_of(file), file, read_pieces(stored.file, stored.result.done));
  } else {
    a.log.emplace(records_of(file), file);
    copy_records(stored, stored.result.done, loaded.system, *a.log);
  }
}

template <class Result>
EnsembleArchive<Result>::~EnsembleArchive() = default;

template <class Result>
bool EnsembleArchive<Result>::wants_records() const {
  return implementation_->plan.per_trajectory;
}

template <class Result>
void EnsembleArchive<Result>::block(TrajectoryRange range,
                                    std::vector<TrajectoryRecord>&& records) {
  if (implementation_->log) implementation_->log->add(range, std::move(records));
}

template <class Result>
void EnsembleArchive<Result>::mark() {
  Implementation& a = *implementation_;
  a.unwritten.reset();
  try {
    if (a.log) a.log->mark();
  } catch (const InputError& error) {
    a.unwritten = error;
  }
}

template <class Result>
void EnsembleArchive<Result>::save(const Result& so_far) {
  hdf5::silence();
  Implementation& a = *implementation_;
  try {
    a.write(so_far, "running", false);
    a.kept = so_far.done.size();
    a.saved = true;
    a.failures = 0;
  } catch (const InputError& error) {
    if (!a.saved || ++a.failures >= most_failures) throw;
    if (a.plan.warn) a.plan.warn(fmt::format("no checkpoint: {}", error.what()));
  }
}

template <class Result>
void EnsembleArchive<Result>::finish(const Result& result, const std::string& status) {
  hdf5::silence();
  Implementation& a = *implementation_;
  try {
    a.write(result, status, true);
  } catch (const InputError&) {
    // A checkpoint needs less room.
    try {
      a.write(result, "running", false);
      a.kept = result.done.size();
    } catch (const InputError&) {
    }
    throw;
  }
  a.finished = true;
  a.kept = 0;
  if (a.log) a.log->keep(false);
  a.log.reset();
  remove_checkpoint(a.target);
}

template <class Result>
std::uint64_t EnsembleArchive<Result>::kept() const {
  return implementation_->kept;
}

#define CAROM_MAKE(Result) template class EnsembleArchive<Result>;
CAROM_FOR_ENSEMBLES(CAROM_MAKE)
#undef CAROM_MAKE

std::string text_of(const Shard& shard) { return fmt::format("{}/{}", shard.k, shard.of); }

}  // namespace carom
