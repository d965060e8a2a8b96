// Parts of one ensemble become one archive.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "carom/base/error.hpp"
#include "carom/files/ensembles.hpp"
#include "carom/starts/injection.hpp"
#include "files/checkpoint/ensemble_columns.hpp"
#include "files/checkpoint/ensemble_files.hpp"

namespace carom {

using namespace files;

namespace {

// The first trajectories that both hold, if there are any.
std::optional<TrajectoryRange> common(const TrajectoryRanges& a, const TrajectoryRanges& b) {
  for (const TrajectoryRange& x : a.ranges())
    for (const TrajectoryRange& y : b.ranges()) {
      const TrajectoryRange both{std::max(x.first, y.first), std::min(x.last, y.last)};
      if (both.first < both.last) return both;
    }
  return {};
}

std::uint64_t lowest(const TrajectoryRanges& done) {
  return done.ranges().empty() ? std::numeric_limits<std::uint64_t>::max()
                               : done.ranges().front().first;
}

void refuse_others(const StoredEnsemble& part, const StoredEnsemble& first) {
  const auto refuse = [&](const std::string& what) {
    throw InputError(Place{part.file, 0, 0, ""},
                     fmt::format("it does not match '{}': {}", first.file, what),
                     "parts of one ensemble");
  };
  if (part.version != first.version)
    refuse(fmt::format("its version is {}, not {}", part.version, first.version));
  const std::string differs =
      difference(first.system_toml, part.system_toml, keys_of_reports(first));
  if (!differs.empty()) refuse(differs);
  if (part.engine != first.engine || part.everywhere != first.everywhere)
    refuse(fmt::format("its engine is {}, not {}", part.engine, first.engine));
  if (part.per_trajectory != first.per_trajectory)
    refuse(part.per_trajectory ? "it alone has --per-trajectory" : "it has no --per-trajectory");
  if (part.per_trajectory && part.status == "running")
    throw InputError(Place{part.file, 0, 0, ""}, "it is the checkpoint of a run that has not ended",
                     fmt::format("an archive, which carom {} --resume makes of it", part.kind));
}

// The records of one part, in order of index; its file is open only while they are read.
class Source {
 public:
  Source(const std::string& file, const TrajectoryRanges& done, const System& system)
      : file_(file) {
    if (done.size() > 0) head_ = particle_index(system, done.ranges().front().first, 0);
  }
  /// No record has a lower index; the largest number at the end.
  std::uint64_t head() const { return head_; }
  /// Moves all records with indices below `end` from the front to `records`.
  void take(std::uint64_t end, std::vector<TrajectoryRecord>& records) {
    if (!reader_) {
      reader_ = std::make_unique<RecordReader>(file_);
      load();
    }
    if (head_ >= end) return;
    const auto stop = std::lower_bound(
        batch_.begin() + at_, batch_.end(), end,
        [](const TrajectoryRecord& r, std::uint64_t index) { return r.index < index; });
    records.insert(records.end(), batch_.begin() + at_, stop);
    at_ = stop - batch_.begin();
    if (stop == batch_.end())
      load();
    else
      head_ = stop->index;
  }

 private:
  void load() {
    at_ = 0;
    if (reader_->next(batch_)) {
      head_ = batch_.front().index;
      return;
    }
    head_ = std::numeric_limits<std::uint64_t>::max();
    reader_.reset();
    batch_ = {};
  }
  std::string file_;
  std::uint64_t head_ = std::numeric_limits<std::uint64_t>::max();
  std::unique_ptr<RecordReader> reader_;
  std::vector<TrajectoryRecord> batch_;
  std::ptrdiff_t at_ = 0;
};

template <class Result>
void write_records(const ArchiveFile& file, const System& system, std::vector<Source>& sources) {
  auto rows = create_records<Result>(file, system);
  constexpr std::uint64_t none = std::numeric_limits<std::uint64_t>::max();
  for (;;) {
    Source* lowest = nullptr;
    std::uint64_t others = none;
    for (Source& source : sources) {
      if (!lowest || source.head() < lowest->head()) {
        if (lowest) others = std::min(others, lowest->head());
        lowest = &source;
      } else {
        others = std::min(others, source.head());
      }
    }
    if (!lowest || lowest->head() == none) break;
    std::vector<TrajectoryRecord> records;
    lowest->take(others, records);
    for (const TrajectoryRecord& record : records) rows.add(record);
  }
  rows.close();
}

}  // namespace

template <class Result>
SumOfParts<Result> sum_of(const std::vector<std::string>& files, const Shard& shard) {
  SumOfParts<Result> sum;
  System system;
  for (const std::string& file : files) {
    Stored<Result> part = read_ensemble<Result>(file);
    const bool first = sum.parts.empty();
    refuse_others(part, first ? part : sum);
    for (const EnsemblePart& other : sum.parts)
      if (const auto both = common(part.result.done, other.done))
        throw InputError(Place{part.file, 0, 0, ""},
                         fmt::format("trajectories {} to {} are in '{}', too", both->first,
                                     both->last - 1, other.file),
                         "parts that do not overlap");
    sum.parts.push_back({part.file, part.result.done, part.result.seconds});
    refuse_other_version(part);
    if (first) {
      system = read_system(part.system_toml, part.file + ": /system").system;
    }
    check_stored(part, system);
    if (first) {
      static_cast<Stored<Result>&>(sum) = std::move(part);
      continue;
    }
    // Of several ways to write a number, and of several windows, that of the lowest trajectory: the
    // order of the parts cannot matter.
    if (lowest(part.result.done) < lowest(sum.result.done)) sum.system_toml = part.system_toml;
    if (!sum.result.add(part.result)) throw InternalError("parts overlap");
    if (sum.arithmetic.empty()) sum.arithmetic = part.arithmetic;
    sum.result.threads = std::max(sum.result.threads, part.result.threads);
    sum.result.lanes =
        std::max(sum.result.lanes, part.result.lanes);  // as with threads: the most of any part
  }
  sum.shard = shard;
  sum.file.clear();
  sum.result.complete = sum.result.done.missing_from(shard.range(system.run.trajectories)).empty();
  sum.status = sum.result.complete ? "completed" : "incomplete";
  return sum;
}

template <class Result>
void write_sum(const std::string& path, const LoadedSystem& loaded, const Provenance& origin,
               const SumOfParts<Result>& sum, ArchiveLock lock) {
  hdf5::silence();
  if (!lock) lock = lock_archive(path);
  const System& system = loaded.system;
  ArchiveFile file = ArchiveFile::create(aside_of(path), path);
  file.write_head(kind_of(sum.result), loaded, origin);
  write_parts(file, sum.result, sum.shard, sum.everywhere, sum.arithmetic);
  if (!sum.merged.empty())
    hdf5::write_attribute(file.open_group("provenance").get(), "merged", sum.merged, path);
  write_counts(file, sum.result, system);
  if (sum.per_trajectory) {
    std::vector<Source> sources;
    for (const EnsemblePart& part : sum.parts) sources.emplace_back(part.file, part.done, system);
    write_records<Result>(file, system, sources);
  }
  file.finish(sum.status, sum.result.complete);
}

#define CAROM_MAKE(Result)                                                            \
  template SumOfParts<Result> sum_of(const std::vector<std::string>&, const Shard&);  \
  template void write_sum(const std::string&, const LoadedSystem&, const Provenance&, \
                          const SumOfParts<Result>&, ArchiveLock);
CAROM_FOR_ENSEMBLES(CAROM_MAKE)
#undef CAROM_MAKE

}  // namespace carom
