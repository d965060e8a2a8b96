// Reads back the rows of a run's archive.
#include "files/hdf5/stored_rows.hpp"
#include "carom/analyses/run/archive.hpp"

namespace carom {

using namespace files;

namespace {

template <class Row>
std::vector<Row> rows_if_any(const std::string& file, const char* group) {
  return has_group(file, group) ? rows_of<Row>(file, run_archive_kind, group) : std::vector<Row>();
}

}  // namespace

std::vector<HitRow> read_hits(const std::string& file) {
  return rows_of<HitRow>(file, run_archive_kind, "collisions");
}
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

}  // namespace carom
