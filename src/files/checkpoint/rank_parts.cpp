#include "files/checkpoint/rank_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

#include "carom/base/error.hpp"
#include "files/checkpoint/ensemble_columns.hpp"
#include "files/checkpoint/ensemble_files.hpp"

namespace carom::files {

namespace {

namespace fs = std::filesystem;

std::string begin_of_parts(const std::string& file) { return folder_of(file) + "/rank-"; }

// The origin of a stored part, for the archive to which the part is added.
Provenance origin_of(const StoredEnsemble& stored, const EnsembleResult& result) {
  Provenance origin;
  origin.command = stored.origins.back().command;
  origin.engine = stored.engine;
  origin.isa = result.lanes ? name_of(*result.lanes) : "baseline";
  origin.threads = result.threads;
  origin.before.assign(stored.origins.begin(), stored.origins.end() - 1);
  return origin;
}

template <class Result>
void finish_checkpoint(const std::string& file, ArchiveLock lock) {
  if (!lock) lock = lock_archive(file);
  if (!has_checkpoint(file)) return;
  const Stored<Result> stored = read_ensemble<Result>(file);
  if (stored.file == file) return remove_checkpoint(file);
  const LoadedSystem loaded = system_of(stored);
  check_stored(stored, loaded.system);
  typename EnsembleArchive<Result>::Plan plan;
  plan.force = true;
  plan.lock = std::move(lock);
  EnsembleArchive<Result>(file, loaded, origin_of(stored, stored.result), stored, plan)
      .finish(stored.result, "interrupted");
}

}  // namespace

std::string part_of_rank(const std::string& file, int rank) {
  return fmt::format("{}{}", begin_of_parts(file), rank);
}

std::vector<std::string> parts_of_ranks(const std::string& file) {
  std::vector<std::string> parts;
  if (!has_work_folder(file)) return parts;
  const std::string begin = begin_of_parts(file);
  const fs::path folder = fs::path(begin).parent_path();
  std::error_code error;
  for (fs::directory_iterator entry(folder.empty() ? "." : folder, error), end;
       !error && entry != end; entry.increment(error)) {
    std::string part = (folder / entry->path().filename()).string();
    if (!part.starts_with(begin)) continue;
    if (part.ends_with(folder_of(""))) part.resize(part.size() - folder_of("").size());
    const std::string number = part.substr(begin.size());
    if (!number.empty() && number.find_first_not_of("0123456789") == std::string::npos)
      parts.push_back(part);
  }
  std::sort(parts.begin(), parts.end());
  parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
  return parts;
}

template <class Result>
SumOfParts<Result> sum_of_ranks(const std::string& file, const std::vector<std::string>& files,
                                const Shard& shard) {
  SumOfParts<Result> sum = sum_of<Result>(files, shard);
  double before = 0, together = 0;
  for (const EnsemblePart& part : sum.parts) {
    if (part.file == file)
      before = part.seconds;
    else
      together = std::max(together, part.seconds);
  }
  sum.result.seconds = before + together;
  return sum;
}

template <class Result>
void gather_parts(const std::string& file, bool whole, ArchiveLock lock) {
  const std::vector<std::string> parts = parts_of_ranks(file);
  if (!parts.empty() || whole) finish_checkpoint<Result>(file, lock);
  if (parts.empty()) return;
  std::vector<std::string> files;
  std::optional<StoredEnsemble> one;
  TrajectoryRanges kept;
  for (const std::string& part : parts) {
    finish_checkpoint<Result>(part, nullptr);
    if (!exists(part)) continue;
    const Stored<Result> stored = read_ensemble<Result>(part);
    if (!kept.add(stored.result.done)) damaged(part, "'/done' counts trajectories of another rank");
    files.push_back(part);
    one = stored;
  }
  // FILE may be what the ranks went on with; hold the sum already; or be another archive, which
  // --force gave up.
  if (one && exists(file)) {
    std::optional<Stored<Result>> there;
    try {
      there = read_ensemble<Result>(file);
    } catch (const InputError&) {  // what is given up may be anything
    }
    if (there && are_one_ensemble(*there, *one)) {
      TrajectoryRanges all = kept;
      if (all.add(there->result.done))
        files.insert(files.begin(), file);
      else if (there->result.done.size() >= kept.size())
        files.clear();
    }
  }
  if (!files.empty()) {
    const SumOfParts<Result> sum = sum_of_ranks<Result>(file, files, one->shard);
    write_sum(file, system_of(sum), origin_of(sum, sum.result), sum, lock);
  }
  give_up_checkpoint(file);
}
#define CAROM_MAKE(Result)                                                                      \
  template SumOfParts<Result> sum_of_ranks(const std::string&, const std::vector<std::string>&, \
                                           const Shard&);                                       \
  template void gather_parts<Result>(const std::string&, bool, ArchiveLock);
CAROM_FOR_ENSEMBLES(CAROM_MAKE)
#undef CAROM_MAKE

}  // namespace carom::files
