#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <optional>

#include "carom/base/error.hpp"
#include "io/archive_file.hpp"
#include "io/escape_columns.hpp"
#include "io/escape_files.hpp"
#include "io/file_lock.hpp"
#include "io/record_log.hpp"

namespace carom {

using hdf5::Handle;

namespace {

// A full disk may get room again; after so many checkpoints in a row that failed the run ends.
constexpr int most_failures = 6;

}  // namespace

class EscapeArchive::Implementation {
 public:
  Implementation(const std::string& path, const LoadedSystem& system, const Provenance& provenance, const Plan& the_plan)
      : lock(path), target(path), loaded(system), origin(provenance), plan(the_plan) {
    for (const Hole& hole : loaded.system.table->holes) holes.push_back(hole.name);
  }
  ~Implementation() {
    if (finished || kept == 0) std::remove(checkpoint_of(target).c_str());
    if (log) log->keep(!finished && kept > 0);
  }

  void write(const EscapeResult& result, const std::string& status, bool last);

  FileLock lock;
  std::string target;
  LoadedSystem loaded;
  Provenance origin;
  Plan plan;
  std::vector<std::string> holes;
  std::optional<RecordLog> log;
  std::uint64_t kept = 0;
  std::optional<InputError> unwritten;  // records that belong to the next checkpoint
  bool saved = false, finished = false;
  int failures = 0;
};

void write_parts(const ArchiveFile& file, const EscapeResult& result, const Shard& shard, bool everywhere) {
  const Handle provenance = file.open_group("provenance");
  hdf5::write_attribute(provenance.get(), "shard", text_of(shard), file.name());
  hdf5::write_attribute(provenance.get(), "everywhere", std::int64_t{everywhere}, file.name());
  hdf5::write_attribute(provenance.get(), "seconds", result.seconds, file.name());
  hdf5::write_attribute(provenance.get(), "cpu_seconds", result.cpu_seconds, file.name());
  file.add_decisions(result.decisions);
  const auto write = [&](const char* name, std::uint64_t number) {
    hdf5::write_attribute(provenance.get(), name, static_cast<std::int64_t>(number), file.name());
  };
  write("lanes_hits", result.effort.hits);
  write("lanes_left", result.effort.scalar);
  write("lanes_steps", result.effort.steps);
  write("lanes_idle", result.effort.idle);
}

// Aside, synced, renamed: under its name a file is whole or is not there.
void EscapeArchive::Implementation::write(const EscapeResult& result, const std::string& status, bool last) {
  if (unwritten) throw *unwritten;  // what is counted and what is recorded would differ
  ArchiveFile file = ArchiveFile::create(checkpoint_of(target) + ".new", target);
  Provenance now = origin;
  now.threads = result.threads;
  if (result.lanes) now.isa = name_of(*result.lanes);
  file.write_head("escape", loaded, now);
  write_parts(file, result, plan.shard, loaded.system.dynamics.everywhere);
  write_counts(file, result, holes, loaded.system.of_discs());
  if (log && last) {
    hdf5::Columns columns = create_records(file, holes);
    log->read([&](const std::vector<TrajectoryRecord>& records) { append_records(columns, records); });
    columns.close();
  } else if (log) {
    write_pieces(file, log->sync());
  }
  file.set_status(status, last && result.complete);
  file.keep_as(last ? target : checkpoint_of(target));
}

EscapeArchive::EscapeArchive(const std::string& file, const LoadedSystem& loaded, const Provenance& origin,
                             const Plan& plan) {
  refuse_existing(file, plan.force);
  implementation_ = std::make_unique<Implementation>(file, loaded, origin, plan);
  if (plan.per_trajectory) implementation_->log.emplace(records_of(file), file);
}

EscapeArchive::EscapeArchive(const std::string& file, const LoadedSystem& loaded, const Provenance& origin,
                             const StoredEscape& stored, const Plan& plan) {
  implementation_ = std::make_unique<Implementation>(file, loaded, origin, plan);
  Implementation& a = *implementation_;
  a.origin.before = stored.origins;
  a.plan.per_trajectory = stored.per_trajectory;
  a.plan.shard = stored.shard;
  const bool goes_on = stored.file == checkpoint_of(file);
  if (goes_on) a.kept = stored.result.done.size();
  if (!stored.per_trajectory) return;
  if (goes_on) {
    a.log.emplace(records_of(file), file, read_pieces(stored.file));
  } else {
    a.log.emplace(records_of(file), file);
    copy_records(stored, loaded.system, *a.log);
  }
}

EscapeArchive::~EscapeArchive() = default;

bool EscapeArchive::wants_records() const { return implementation_->plan.per_trajectory; }

void EscapeArchive::block(TrajectoryRange range, std::vector<TrajectoryRecord>&& records) {
  if (implementation_->log) implementation_->log->add(range, std::move(records));
}

void EscapeArchive::mark() {
  Implementation& a = *implementation_;
  a.unwritten.reset();
  try {
    if (a.log) a.log->mark();
  } catch (const InputError& error) {
    a.unwritten = error;
  }
}

void EscapeArchive::save(const EscapeResult& so_far) {
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

void EscapeArchive::finish(const EscapeResult& result, const std::string& status) {
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
}

std::uint64_t EscapeArchive::kept() const { return implementation_->kept; }

std::string text_of(const Shard& shard) { return fmt::format("{}/{}", shard.k, shard.of); }

}  // namespace carom
