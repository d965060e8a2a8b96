// The files of an ensemble that has not ended, and how their records are read.
#pragma once

#include <string>
#include <vector>

#include "carom/io/archive.hpp"
#include "io/archive_file.hpp"
#include "io/record_log.hpp"

namespace carom {

inline std::string checkpoint_of(const std::string& file) { return file + ".part"; }
inline std::string records_of(const std::string& file) { return file + ".records"; }
bool exists(const std::string& file);
/// For whoever holds the lock of `file`: removes its checkpoint, if it has one.
void remove_checkpoint(const std::string& file);

/// /provenance of an ensemble, besides what every archive has; what is counted.
void write_parts(const ArchiveFile&, const EnsembleResult&, const Shard&, bool everywhere);
/// Where the records of a checkpoint stand.
void write_pieces(const ArchiveFile&, const std::vector<RecordLog::Piece>&);
/// Throws InputError where they are not those of the trajectories that it counts.
std::vector<RecordLog::Piece> read_pieces(const std::string& checkpoint, const TrajectoryRanges& done);
/// All records of an archive to a log.
void copy_records(const StoredEnsemble&, const TrajectoryRanges& done, const System&, RecordLog&);

}  // namespace carom
