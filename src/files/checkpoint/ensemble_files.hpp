// The files of an ensemble that has not ended, and how their records are read.
#pragma once

#include <string>
#include <vector>

#include "carom/files/ensembles.hpp"
#include "files/checkpoint/record_log.hpp"
#include "files/checkpoint/work_folder.hpp"
#include "files/hdf5/archive_file.hpp"

namespace carom::files {

/// Do both hold parts of one ensemble, or the whole, by one version?
bool are_one_ensemble(const StoredEnsemble&, const StoredEnsemble&);
/// Opens an archive of this schema; throws InputError for anything else.
hdf5::Handle open_ensemble(const std::string& name);

/// /provenance of an ensemble, besides what every archive has; what is counted. `arithmetic`: the
/// fingerprint of the build that computed it, or "".
void write_parts(const ArchiveFile&, const EnsembleResult&, const Shard&, bool everywhere,
                 const std::string& arithmetic);
inline constexpr const char* arithmetic_key = "arithmetic";
/// The places of a checkpoint's records in the file of records.
void write_pieces(const ArchiveFile&, const std::vector<RecordLog::Piece>&);
/// Throws InputError where they are not those of the trajectories that it counts.
std::vector<RecordLog::Piece> read_pieces(const std::string& checkpoint,
                                          const TrajectoryRanges& done);
/// All records of an archive to a log, in order of index.
void copy_records(const StoredEnsemble&, const TrajectoryRanges& done, const System&, RecordLog&);

}  // namespace carom::files
