// An ensemble that several processes share: each keeps its share in an archive of its own.
#pragma once

#include <string>
#include <vector>

#include "carom/files/archive.hpp"
#include "carom/files/ensembles.hpp"

namespace carom::files {

/// The archive of a rank's share of FILE; ranks count from 0.
std::string part_of_rank(const std::string& file, int rank);
/// The parts that exist, finished or as checkpoints.
std::vector<std::string> parts_of_ranks(const std::string& file);

/// The sum of the shares, and of FILE where it is one of the files. `seconds` is the time that
/// passed: shares run side by side.
template <class Result>
SumOfParts<Result> sum_of_ranks(const std::string& file, const std::vector<std::string>& files,
                                const Shard&);

/// Called by the process that holds the lock of FILE: adds the parts that ranks have left to FILE,
/// together with the checkpoint of FILE if there are such parts or `whole` is set.
template <class Result>
void gather_parts(const std::string& file, bool whole, ArchiveLock);

}  // namespace carom::files
