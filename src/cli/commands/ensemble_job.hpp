// Which ensemble a command is to run: a new one, a part of it, or one that goes on.
#pragma once

#include <optional>
#include <string>

#include "carom/analyses/kinds.hpp"
#include "carom/files/archive.hpp"
#include "carom/files/ensembles.hpp"
#include "carom/files/system_file.hpp"
#include "cli/options.hpp"

namespace carom::cli {

template <class Result>
struct EnsembleJob {
  ArchiveLock lock;  ///< of the archive, taken before anything was read; none without an archive
  LoadedSystem loaded;
  std::string output;  ///< archive, or ""
  Shard shard;
  std::optional<Stored<Result>> stored;  ///< what it goes on with
};
/// The first of the processes that share a run writes the archive; the others only read.
enum class Sharing { alone, first, other };
/// What --resume names. Throws InputError if the stored ensemble is another one, and says what
/// differs.
template <class Result>
EnsembleJob<Result> job_to_go_on(const Options&, Sharing);
/// The part that --shard names: all without it.
Shard shard_of(const Options&);

/// Does the command only add up trajectories? Then it can be divided, continued and shared.
bool is_plain_ensemble(const Options&);
/// Checkpoints are so many seconds apart, or so many blocks.
struct CheckpointInterval {
  double seconds = 10;
  std::uint64_t blocks = 0;  ///< 0: seconds count
};
CheckpointInterval checkpoint_interval(const std::string& text);

}  // namespace carom::cli
