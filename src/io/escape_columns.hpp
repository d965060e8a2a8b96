// What an escape ensemble adds up, and the records of its trajectories, as datasets.
#pragma once

#include <string>
#include <vector>

#include "carom/ensemble/escape.hpp"
#include "io/archive_file.hpp"
#include "io/columns.hpp"

namespace carom {

void write_counts(const ArchiveFile&, const EscapeResult&, const std::vector<std::string>& holes, bool of_discs);
/// Counts, digest, done and reports.
EscapeResult read_counts(hid_t file, const std::string& name);

hdf5::Columns create_records(const ArchiveFile&, const std::vector<std::string>& holes);
void append_records(hdf5::Columns&, const std::vector<TrajectoryRecord>&);

/// Reads /trajectories in batches.
class RecordReader {
 public:
  explicit RecordReader(const std::string& file);
  /// False, and no records, at the end.
  bool next(std::vector<TrajectoryRecord>&);

 private:
  std::string name_;
  hdf5::Handle file_;
  std::vector<hdf5::Handle> columns_;
  std::size_t row_ = 0, left_ = 0;
};

}  // namespace carom
