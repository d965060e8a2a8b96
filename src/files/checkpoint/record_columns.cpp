// The records of trajectories as datasets.
#include <algorithm>
#include <cstddef>

#include "carom/base/error.hpp"
#include "carom/table/hole_names.hpp"
#include "files/checkpoint/ensemble_columns.hpp"
#include "files/hdf5/stored_rows.hpp"

namespace carom::files {

using hdf5::Handle;

std::vector<std::string> fate_names() {
  std::vector<std::string> names;
  for (int i = 0; i <= static_cast<int>(last_fate); ++i)
    names.push_back(name_of(static_cast<Fate>(i)));
  return names;
}

void name_record_columns(const ArchiveFile& file, const System& system) {
  const Handle group = file.open_group("trajectories");
  const auto name = [&](const char* column, const std::vector<std::string>& names) {
    if (names.empty() || !hdf5::has(group.get(), column)) return;
    hdf5::write_attribute(hdf5::open_column(group.get(), column, file.name()).get(), "names", names,
                          file.name());
  };
  name("fate", fate_names());
  name("hole", hole_names(*system.table));
  name("regularity", {"linear", "chaotic", "undecided"});
}

RecordReader::RecordReader(const std::string& file) : name_(file), file_(open_finished(file)) {
  const Handle group(H5Gopen2(file_.get(), "trajectories", H5P_DEFAULT), H5Gclose);
  if (!group) throw InputError(Place{file, 0, 0, ""}, "it holds no records of trajectories");
  rows_.emplace(group.get(), file);
}

bool RecordReader::next(std::vector<TrajectoryRecord>& records) {
  constexpr std::size_t batch = 65536;
  records.assign(std::min(batch, rows()), {});
  rows_->read(row_, records);
  for (std::size_t i = 0; i < records.size(); ++i) {
    const TrajectoryRecord& r = records[i];
    if (row_ + i > 0 && r.index <= last_) damaged(name_, "'/trajectories/index' is not in order");
    if (r.fate < Fate{} || r.fate > last_fate)
      damaged(name_, "'/trajectories/fate' has a number that is no fate");
    last_ = r.index;
  }
  row_ += records.size();
  return !records.empty();
}

}  // namespace carom::files

namespace carom {

using namespace files;

std::vector<TrajectoryRecord> read_trajectories(const std::string& file) {
  std::vector<TrajectoryRecord> all, batch;
  if (!has_group(file, "trajectories")) return all;
  RecordReader reader(file);
  all.reserve(reader.rows());
  while (reader.next(batch)) all.insert(all.end(), batch.begin(), batch.end());
  return all;
}

}  // namespace carom
