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
/// Is it an ensemble that has not ended? Files that cannot be read are none, nor are archives that ended.
bool is_checkpoint(const std::string& path);
/// Has FILE.h5 a checkpoint that names FILE.records?
bool has_records(const std::string& file);
bool is_empty(const std::string& file);
/// Is there something of this name that is no file: a device, a pipe, a folder? Nothing replaces it, and nothing reads it.
bool is_no_file(const std::string& path);
/// Throws InputError where `file`, which is to be written, is no file.
void refuse_no_file(const std::string& file);
/// Throws InputError where the checkpoint or the records of FILE.h5 would replace a file that is none: `force` replaces it,
/// unless it is a whole archive of another name, or no file at all.
void refuse_files_of_others(const std::string& file, bool force);
/// Throws InputError where `aside`, where FILE.h5 is written first, is a file of somebody else, unless `force` replaces it.
/// What is no file is always refused.
void refuse_aside_of_others(const std::string& file, const std::string& aside, bool force);
/// Where an ensemble of this name stands: FILE.h5.part if that is its checkpoint, else FILE.h5.
std::string stored_in(const std::string& file);
/// Do both hold parts of one ensemble, or the whole, by one version?
bool are_one_ensemble(const StoredEnsemble&, const StoredEnsemble&);
/// Opens an archive of this schema; throws InputError for anything else.
hdf5::Handle open_ensemble(const std::string& name);

/// /provenance of an ensemble, besides what every archive has; what is counted. `arithmetic`: of those who computed it, or "".
void write_parts(const ArchiveFile&, const EnsembleResult&, const Shard&, bool everywhere, const std::string& arithmetic);
inline constexpr const char* arithmetic_key = "arithmetic";
/// Where the records of a checkpoint stand.
void write_pieces(const ArchiveFile&, const std::vector<RecordLog::Piece>&);
/// Throws InputError where they are not those of the trajectories that it counts.
std::vector<RecordLog::Piece> read_pieces(const std::string& checkpoint, const TrajectoryRanges& done);
/// Does a file hold nothing but records of the archive from its first one on, as copy_records leaves it where it is killed?
bool holds_copies(const std::string& path, const StoredEnsemble&);
/// All records of an archive to a log, in order of index.
void copy_records(const StoredEnsemble&, const TrajectoryRanges& done, const System&, RecordLog&);

}  // namespace carom
