// Reads back the rows of archives: hits and samples of a run, points of a section.
#include "carom/base/error.hpp"
#include "carom/io/archive.hpp"
#include "io/archive/archive_file.hpp"
#include "io/archive/checksums.hpp"
#include "io/archive/ensemble_columns.hpp"
#include "io/archive/fields.hpp"
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

// The rows of a group.
template <class Row>
std::vector<Row> rows_of(const std::string& name, const char* kind, const char* group) {
  const Handle file = opened(name);
  if (hdf5::read_string_attribute(file.get(), "kind", name) != kind)
    throw InputError(Place{name, 0, 0, ""}, std::string("the archive holds no ") + kind,
                     std::string("an archive written by carom ") + kind);
  hdf5::verify(file.get(), name);
  const Handle rows(H5Gopen2(file.get(), group, H5P_DEFAULT), H5Gclose);
  if (!rows) throw InputError(Place{name, 0, 0, group}, "the archive is damaged");
  return read_all_rows<Row>(rows.get(), name);
}

}  // namespace

std::vector<HitRow> read_hits(const std::string& file) {
  return rows_of<HitRow>(file, run_archive_kind, "collisions");
}

namespace {

// Archives have the group only where there can be rows.
bool has_group(const std::string& file, const char* group) {
  return hdf5::has(opened(file).get(), group);
}

template <class Row>
std::vector<Row> rows_if_any(const std::string& file, const char* group) {
  return has_group(file, group) ? rows_of<Row>(file, run_archive_kind, group) : std::vector<Row>();
}

}  // namespace

std::vector<SampleRow> read_samples(const std::string& file) {
  return rows_of<SampleRow>(file, run_archive_kind, "trajectory");
}
std::vector<SampleRow> read_starts(const std::string& file) {
  return rows_if_any<SampleRow>(file, "start");
}
std::vector<ContactRow> read_contacts(const std::string& file) {
  return rows_if_any<ContactRow>(file, "contacts");
}
std::vector<EnergyRow> read_energies(const std::string& file) {
  return rows_if_any<EnergyRow>(file, "energy");
}

std::vector<TrajectoryRecord> read_trajectories(const std::string& file) {
  std::vector<TrajectoryRecord> all, batch;
  if (!has_group(file, "trajectories")) return all;
  RecordReader reader(file);
  all.reserve(reader.rows());
  while (reader.next(batch)) all.insert(all.end(), batch.begin(), batch.end());
  return all;
}

StoredSection read_section(const std::string& name) {
  StoredSection stored;
  stored.points = rows_of<SectionPoint>(name, section_archive_kind, "section");
  const Handle file = opened(name);
  const Handle fates(H5Gopen2(file.get(), "fates", H5P_DEFAULT), H5Gclose);
  SectionResult& result = stored.result;
  read_numbers(fates.get(), result, name);
  read_integration(fates.get(), name, result.steps, result.energy_error);
  result.complete = hdf5::read_integer_attribute(file.get(), "complete", name) != 0;
  stored.system_toml = hdf5::read_text(file.get(), "system", name);
  const std::size_t particles =
      read_system(stored.system_toml, name + ": /system").system.particles.size();
  static_cast<FateCounts&>(result) = read_fates(fates, name, result.orbits * particles);
  const Handle provenance(H5Gopen2(file.get(), "provenance", H5P_DEFAULT), H5Gclose);
  stored.system_name = hdf5::read_string_attribute(provenance.get(), "system", name);
  stored.engine = hdf5::read_string_attribute(provenance.get(), "engine", name);
  const Seconds seconds = ArchiveFile::read_seconds(provenance.get(), name);
  result.seconds = seconds.wall;
  result.cpu_seconds = seconds.cpu;
  result.threads =
      static_cast<int>(hdf5::read_integer_attribute(provenance.get(), "threads", name));
  return stored;
}

std::string kind_of_archive(const std::string& file) {
  return hdf5::read_string_attribute(opened(file).get(), "kind", file);
}

}  // namespace carom
