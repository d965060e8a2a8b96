// Reads back the rows of archives: hits and samples of a run, points of a section.
#include <optional>

#include "carom/base/error.hpp"
#include "carom/io/archive.hpp"
#include "io/archive/archive_file.hpp"
#include "io/archive/checksums.hpp"
#include "io/archive/ensemble_columns.hpp"
#include "io/archive/hdf5.hpp"
#include "io/archive/section_numbers.hpp"
#include "io/checkpoint/ensemble_files.hpp"

namespace carom {

using namespace io;

namespace {

using hdf5::Handle;

Handle opened(const std::string& name) {
  hdf5::silence();
  return open_archive(name, "the file is not an archive, or it is still being written",
                      "an archive of carom");
}

// A group of columns of equal length.
class Group {
 public:
  Group(const std::string& name, const char* kind, const char* group)
      : name_(name), file_(opened(name)) {
    if (hdf5::read_string_attribute(file_.get(), "kind", name) != kind)
      throw InputError(Place{name, 0, 0, ""}, std::string("the archive holds no ") + kind,
                       std::string("an archive written by carom ") + kind);
    hdf5::verify(file_.get(), name);
    group_ = Handle(H5Gopen2(file_.get(), group, H5P_DEFAULT), H5Gclose);
    if (!group_) throw InputError(Place{name, 0, 0, group}, "the archive is damaged");
  }
  hid_t file() const { return file_.get(); }

  template <class Row, class T>
  void read(std::vector<Row>& rows, const char* column, T Row::*member) const {
    const std::vector<T> values = hdf5::read_column<T>(group_.get(), column, name_);
    if (length_.value_or(values.size()) != values.size())
      throw InputError(Place{name_, 0, 0, ""},
                       std::string("'") + column + "' has another length than its neighbours",
                       "an archive as carom wrote it");
    length_ = values.size();
    rows.resize(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) rows[i].*member = values[i];
  }
  template <class Row>
  void read_motion(std::vector<Row>& rows) const {
    read(rows, "particle", &Row::particle);
    read(rows, "t", &Row::t);
    read(rows, "x", &Row::x);
    read(rows, "y", &Row::y);
    read(rows, "vx", &Row::vx);
    read(rows, "vy", &Row::vy);
  }
  template <class Row>
  void read_cells(std::vector<Row>& rows) const {
    read(rows, "cell_first", &Row::cell_first);
    read(rows, "cell_second", &Row::cell_second);
  }

 private:
  std::string name_;
  Handle file_, group_;
  mutable std::optional<std::size_t> length_;  // of all columns
};

}  // namespace

std::vector<HitRow> read_hits(const std::string& file) {
  const Group group(file, run_archive_kind, "collisions");
  std::vector<HitRow> rows;
  group.read_motion(rows);
  group.read_cells(rows);
  group.read(rows, "wall", &HitRow::wall);
  group.read(rows, "s", &HitRow::s);
  group.read(rows, "v_parallel", &HitRow::v_parallel);
  group.read(rows, "reflections", &HitRow::reflections);
  return rows;
}

namespace {

// Archives have the group only where there can be rows.
bool has_group(const std::string& file, const char* group) {
  return hdf5::has(opened(file).get(), group);
}

std::vector<SampleRow> sample_rows(const std::string& file, const char* of) {
  const Group group(file, run_archive_kind, of);
  std::vector<SampleRow> rows;
  group.read_motion(rows);
  group.read_cells(rows);
  return rows;
}

}  // namespace

std::vector<SampleRow> read_samples(const std::string& file) {
  return sample_rows(file, "trajectory");
}
std::vector<SampleRow> read_starts(const std::string& file) {
  return has_group(file, "start") ? sample_rows(file, "start") : std::vector<SampleRow>();
}

std::vector<ContactRow> read_contacts(const std::string& file) {
  std::vector<ContactRow> rows;
  if (!has_group(file, "contacts")) return rows;
  const Group group(file, run_archive_kind, "contacts");
  group.read(rows, "first", &ContactRow::first);
  group.read(rows, "second", &ContactRow::second);
  group.read(rows, "t", &ContactRow::t);
  group.read(rows, "first_x", &ContactRow::first_x);
  group.read(rows, "first_y", &ContactRow::first_y);
  group.read(rows, "second_x", &ContactRow::second_x);
  group.read(rows, "second_y", &ContactRow::second_y);
  group.read(rows, "dx", &ContactRow::dx);
  group.read(rows, "dy", &ContactRow::dy);
  group.read(rows, "first_vx", &ContactRow::first_vx);
  group.read(rows, "first_vy", &ContactRow::first_vy);
  group.read(rows, "second_vx", &ContactRow::second_vx);
  group.read(rows, "second_vy", &ContactRow::second_vy);
  group.read(rows, "transfer", &ContactRow::transfer);
  return rows;
}

std::vector<EnergyRow> read_energies(const std::string& file) {
  std::vector<EnergyRow> rows;
  if (!has_group(file, "energy")) return rows;
  const Group group(file, run_archive_kind, "energy");
  group.read(rows, "t", &EnergyRow::t);
  group.read(rows, "kinetic", &EnergyRow::kinetic);
  group.read(rows, "external", &EnergyRow::external);
  group.read(rows, "pair", &EnergyRow::pair);
  group.read(rows, "total", &EnergyRow::total);
  group.read(rows, "px", &EnergyRow::px);
  group.read(rows, "py", &EnergyRow::py);
  group.read(rows, "angular_momentum", &EnergyRow::angular_momentum);
  return rows;
}

std::vector<TrajectoryRecord> read_trajectories(const std::string& file) {
  std::vector<TrajectoryRecord> all, batch;
  if (!has_group(file, "trajectories")) return all;
  RecordReader reader(file);
  all.reserve(reader.rows());
  while (reader.next(batch)) all.insert(all.end(), batch.begin(), batch.end());
  return all;
}

StoredSection read_section(const std::string& file) {
  const Group group(file, section_archive_kind, "section");
  StoredSection stored;
  std::vector<SectionPoint>& rows = stored.points;
  group.read_motion(rows);
  group.read(rows, "orbit", &SectionPoint::orbit);
  group.read(rows, "index", &SectionPoint::index);
  group.read(rows, "wall", &SectionPoint::wall);
  group.read(rows, "direction", &SectionPoint::direction);
  group.read(rows, "s", &SectionPoint::s);
  group.read(rows, "v_parallel", &SectionPoint::v_parallel);
  const Handle fates(H5Gopen2(group.file(), "fates", H5P_DEFAULT), H5Gclose);
  for (const SectionNumber& number : section_numbers)
    stored.result.*number.value =
        hdf5::read_column<std::uint64_t>(fates.get(), number.name, file).at(0);
  read_integration(fates.get(), file, stored.result.steps, stored.result.energy_error);
  stored.result.complete = hdf5::read_integer_attribute(group.file(), "complete", file) != 0;
  stored.system_toml = hdf5::read_text(group.file(), "system", file);
  const std::size_t particles =
      read_system(stored.system_toml, file + ": /system").system.particles.size();
  static_cast<FateCounts&>(stored.result) =
      read_fates(fates, file, stored.result.orbits * particles);
  const Handle provenance(H5Gopen2(group.file(), "provenance", H5P_DEFAULT), H5Gclose);
  stored.system_name = hdf5::read_string_attribute(provenance.get(), "system", file);
  stored.engine = hdf5::read_string_attribute(provenance.get(), "engine", file);
  const Seconds seconds = ArchiveFile::read_seconds(provenance.get(), file);
  stored.result.seconds = seconds.wall;
  stored.result.cpu_seconds = seconds.cpu;
  stored.result.threads =
      static_cast<int>(hdf5::read_integer_attribute(provenance.get(), "threads", file));
  return stored;
}

std::string kind_of_archive(const std::string& file) {
  return hdf5::read_string_attribute(opened(file).get(), "kind", file);
}

}  // namespace carom
