// What each kind of ensemble adds up, and the records of trajectories, as datasets.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "carom/analyses/kinds.hpp"
#include "carom/files/ensembles.hpp"
#include "files/hdf5/archive_file.hpp"
#include "files/hdf5/fields.hpp"

namespace carom::files {

/// Trajectories that are counted, and reports of those that failed.
void write_done(const ArchiveFile&, const EnsembleResult&);
void read_done(hid_t file, const std::string& name, EnsembleResult&);

/// What describe() says of it.
void write_counts(const ArchiveFile&, const auto&, const System&);
void read_counts(hid_t file, const std::string& name, auto&);

/// The fates of /fates add up to `all` particles: InputError where they do not.
FateCounts read_fates(const hdf5::Handle& fates, const std::string& name, std::uint64_t all);
/// What integration has cost, and how well energies were kept; nothing where none was.
void write_integration(hid_t fates, const StepCounts&, const EnergyError&, const std::string& name);
void read_integration(hid_t fates, const std::string& name, StepCounts&, EnergyError&);

/// Names of all fates, by their number.
std::vector<std::string> fate_names();
void name_record_columns(const ArchiveFile&, const System&);
/// Creates /trajectories.
template <class Result>
auto create_records(const ArchiveFile& file, const System& system) {
  Rows<TrajectoryRecord, typename Result::RecordFields> rows(file.name());
  rows.create(file.group("trajectories", "Start and end of each trajectory, by index").get());
  name_record_columns(file, system);
  return rows;
}

/// Reads /trajectories in batches.
class RecordReader {
 public:
  explicit RecordReader(const std::string& file);
  /// Rows that have not been read.
  std::size_t rows() const { return rows_->rows() - row_; }
  /// False, and no records, at the end. Throws InputError where they are not in order of index.
  bool next(std::vector<TrajectoryRecord>&);

 private:
  std::string name_;
  hdf5::Handle file_;
  std::optional<RowReader<TrajectoryRecord, ExponentFields>> rows_;
  std::size_t row_ = 0;
  std::uint64_t last_ = 0;  ///< index of the last that was read
};

}  // namespace carom::files
