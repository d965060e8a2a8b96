// The records of trajectories as datasets.
#include <algorithm>
#include <cstddef>

#include "carom/base/error.hpp"
#include "carom/table/hole_names.hpp"
#include "io/archive/ensemble_columns.hpp"

namespace carom::io {

using hdf5::Handle;

hdf5::Columns create_records(const ArchiveFile& file, const System& system, bool exponents) {
  const std::string& target = file.name();
  const std::vector<std::string> holes = hole_names(*system.table);
  hdf5::Columns trajectories(target);
  const Handle group = file.group("trajectories", "Start and end of each trajectory, by index");
  const hid_t to = group.get();
  trajectories.add<std::uint64_t>(
      to, "index",
      {"1", "trajectory * particles + particle; with injections trajectory * 2^20 + particle"});
  trajectories.add<double>(to, "x", {"length", "Start, unwrapped"});
  trajectories.add<double>(to, "y", {"length", "Start, unwrapped"});
  trajectories.add<double>(to, "vx", {"length/time", "Velocity at the start"});
  trajectories.add<double>(to, "vy", {"length/time", "Velocity at the start"});
  const hid_t fate =
      trajectories.add<std::int32_t>(to, "fate", {"1", "Index into the attribute `names`"});
  std::vector<std::string> names;
  for (int i = 0; i <= static_cast<int>(last_fate); ++i)
    names.push_back(name_of(static_cast<Fate>(i)));
  hdf5::write_attribute(fate, "names", names, target);
  const hid_t hole = trajectories.add<std::int32_t>(
      to, "hole", {"1", "Index into the attribute `names`, -1: did not escape"});
  if (!holes.empty()) hdf5::write_attribute(hole, "names", holes, target);
  trajectories.add<double>(
      to, "t", {"time", "End: escape, last hit of an unbounded one, else the time reached"});
  trajectories.add<std::uint64_t>(to, "hits", {"1", "Reflections"});
  trajectories.add<std::int32_t>(to, "wall", {"1", "Of the start, -1: it lies off the walls"});
  trajectories.add<double>(to, "s", {"length", "Start: arc length along its wall, NaN: off walls"});
  trajectories.add<double>(to, "v_parallel",
                           {"length/time", "Start: velocity along its wall, NaN: off walls"});
  if (!exponents) return trajectories;
  trajectories.add<double>(to, "lambda",
                           {"1/time", "Finite-time exponent, NaN: ended before it was looked at"});
  trajectories.add<double>(to, "sali", {"1", "Angle between two deviations (SALI)"});
  const hid_t regularity =
      trajectories.add<std::int32_t>(to, "regularity", {"1", "Index into the attribute `names`"});
  hdf5::write_attribute(regularity, "names",
                        std::vector<std::string>{"linear", "chaotic", "undecided"}, target);
  return trajectories;
}

void append_records(hdf5::Columns& trajectories, const std::vector<TrajectoryRecord>& records,
                    bool exponents) {
  for (const TrajectoryRecord& r : records) {
    const auto fate = static_cast<std::int32_t>(r.fate);
    if (exponents)
      trajectories.row(r.index, r.x, r.y, r.vx, r.vy, fate, r.hole, r.time, r.hits, r.wall, r.s,
                       r.v_parallel, r.lambda, r.sali, static_cast<std::int32_t>(r.regularity));
    else
      trajectories.row(r.index, r.x, r.y, r.vx, r.vy, fate, r.hole, r.time, r.hits, r.wall, r.s,
                       r.v_parallel);
  }
}

RecordReader::RecordReader(const std::string& file) : name_(file) {
  file_ = Handle(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  const Handle group(H5Gopen2(file_.get(), "trajectories", H5P_DEFAULT), H5Gclose);
  if (!group) throw InputError(Place{file, 0, 0, ""}, "it holds no records of trajectories");
  std::vector<const char*> names = {"index", "x", "y", "vx", "vy", "fate", "hole", "t", "hits"};
  // Archives of earlier builds have none of these, those of escapes not the last ones.
  const auto there = [&](const char* column) { return hdf5::has(group.get(), column); };
  if (starts_ = there("s"); starts_) names.insert(names.end(), {"wall", "s", "v_parallel"});
  if (exponents_ = starts_ && there("lambda"); exponents_)
    names.insert(names.end(), {"lambda", "sali", "regularity"});
  for (const char* column : names) columns_.push_back(hdf5::open_column(group.get(), column, file));
  left_ = hdf5::rows_of(columns_.front().get(), file);
  for (std::size_t i = 1; i < columns_.size(); ++i)
    if (hdf5::rows_of(columns_[i].get(), file) != left_)
      damaged(file, std::string("'/trajectories/index' and '/trajectories/") + names[i] +
                        "' differ in length");
}

bool RecordReader::next(std::vector<TrajectoryRecord>& records) {
  constexpr std::size_t batch = 65536;
  const std::size_t count = std::min(batch, left_);
  records.resize(count);
  if (count == 0) return false;
  const auto column = [&](std::size_t number, auto kind, auto put) {
    std::vector<decltype(kind)> values(count);
    hdf5::read_rows(columns_[number].get(), hdf5::native_type<decltype(kind)>(), row_, count,
                    values.data(), name_);
    for (std::size_t i = 0; i < count; ++i) put(records[i], values[i]);
  };
  using Record = TrajectoryRecord;
  column(0, std::uint64_t{}, [](Record& r, std::uint64_t value) { r.index = value; });
  column(1, double{}, [](Record& r, double value) { r.x = value; });
  column(2, double{}, [](Record& r, double value) { r.y = value; });
  column(3, double{}, [](Record& r, double value) { r.vx = value; });
  column(4, double{}, [](Record& r, double value) { r.vy = value; });
  column(5, std::int32_t{},
         [](Record& r, std::int32_t value) { r.fate = static_cast<Fate>(value); });
  column(6, std::int32_t{}, [](Record& r, std::int32_t value) { r.hole = value; });
  column(7, double{}, [](Record& r, double value) { r.time = value; });
  column(8, std::uint64_t{}, [](Record& r, std::uint64_t value) { r.hits = value; });
  if (starts_) {
    column(9, std::int32_t{}, [](Record& r, std::int32_t value) { r.wall = value; });
    column(10, double{}, [](Record& r, double value) { r.s = value; });
    column(11, double{}, [](Record& r, double value) { r.v_parallel = value; });
  }
  if (exponents_) {
    column(12, double{}, [](Record& r, double value) { r.lambda = value; });
    column(13, double{}, [](Record& r, double value) { r.sali = value; });
    column(14, std::int32_t{},
           [](Record& r, std::int32_t value) { r.regularity = static_cast<unsigned char>(value); });
  }
  for (std::size_t i = 0; i < count; ++i) {
    const TrajectoryRecord& r = records[i];
    if (row_ + i > 0 && r.index <= last_) damaged(name_, "'/trajectories/index' is not in order");
    if (r.fate < Fate{} || r.fate > last_fate)
      damaged(name_, "'/trajectories/fate' has a number that is no fate");
    last_ = r.index;
  }
  row_ += count;
  left_ -= count;
  return true;
}

}  // namespace carom::io
