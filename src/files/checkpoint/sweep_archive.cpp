#include "files/checkpoint/sweep_archive.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

#include "carom/base/error.hpp"
#include "files/checkpoint/ensemble_columns.hpp"
#include "files/checkpoint/work_folder.hpp"
#include "files/hdf5/archive_file.hpp"
#include "files/hdf5/checksums.hpp"

namespace carom::files {

using hdf5::Handle;

namespace {

constexpr const char *report_name = "report", *archive_name = "archive";

Handle opened(const std::string& file) {
  hdf5::silence();
  return open_archive(file, "the file is not an archive", "an archive written by carom");
}

std::string path_of(std::size_t index) { return fmt::format("values/{}", index); }

void write_table(const ArchiveFile& file, const SweepPlan& plan,
                 const std::vector<SweepNumbers>& table) {
  const std::string& name = file.name();
  const Handle group = file.group("sweep", "The table: a row for each value of /values");
  hdf5::write_text(group.get(), "plan", plan.json().text(),
                   {"JSON", "The keys, their values as they are written, the systems"}, name);
  std::vector<std::string> keys;
  for (const SweptKey& key : plan.keys) keys.push_back(key.key);
  hdf5::write_attribute(group.get(), "keys", keys, name);
  hdf5::write_attribute(group.get(), "command", std::string_view(plan.command), name);
  for (std::size_t k = 0; k < plan.keys.size(); ++k) {
    std::vector<double> values;
    for (std::size_t i = 0; i < plan.systems.size(); ++i)
      values.push_back(ExactNumber(plan.at(i)[k]).to_double());
    hdf5::write_column(group.get(), keys[k].c_str(), std::span<const double>(values),
                       {"as of the key", "What the key was set to"}, name);
  }
  for (const SweepNumbers& column : table)
    hdf5::write_column(group.get(), column.name.c_str(), std::span<const double>(column.values),
                       {"as in the report", column.description.c_str()}, name);
}

std::vector<std::uint8_t> bytes_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(in), {}};
  hdf5::check(in.good(), file);
  return bytes;
}

void write_value(const ArchiveFile& file, const SweepPlan& plan, std::size_t index) {
  const std::string &name = file.name(), path = path_of(index);
  const Handle group = file.group(path.c_str(), "A value: its report, its archive");
  if (const auto report = kept_report(name, plan, index))
    hdf5::write_text(group.get(), report_name, *report,
                     {"JSON", "What the command prints of it with --json"}, name);
  const std::string archive = value_of_sweep(name, index);
  if (!exists(archive)) return;
  // Its bytes: H5Ocopy of HDF5 1.10 crashes on texts of variable length among many attributes.
  const std::vector<std::uint8_t> bytes = bytes_of(archive);
  hdf5::write_column(group.get(), archive_name, std::span<const std::uint8_t>(bytes),
                     {"bytes", "The archive that this value alone would have"}, name);
}

bool extract(hid_t file, const std::string& name, std::size_t index, const std::string& target) {
  const Handle value = open_group(file, path_of(index).c_str(), name);
  if (!hdf5::has(value.get(), archive_name)) return false;
  const auto bytes = hdf5::read_column<std::uint8_t>(value.get(), archive_name, name);
  errno = 0;
  hdf5::check(write_new_file(target, {reinterpret_cast<const char*>(bytes.data()), bytes.size()}),
              target);
  return true;
}

}  // namespace

void write_sweep(const std::string& file, const LoadedSystem& base, const SweepPlan& plan,
                 const std::vector<SweepNumbers>& table, const Provenance& origin,
                 const std::string& status, bool complete) {
  hdf5::silence();
  {
    ArchiveFile made = ArchiveFile::create(aside_of(file), file);
    made.write_head(sweep_archive_kind, base, origin);
    write_table(made, plan, table);
    const Handle values = made.group("values", "The values of the sweep, from 0 on");
    for (std::size_t i = 0; i < plan.systems.size(); ++i) write_value(made, plan, i);
    made.set_status(status, complete);
    made.keep_as(file);
  }
  remove_sweep(file);
}

StoredSweep read_sweep(const std::string& file) {
  const Handle archive = opened(file);
  const hid_t from = archive.get();
  if (hdf5::read_string_attribute(from, "kind", file) != sweep_archive_kind)
    throw InputError(Place{file, 0, 0, ""}, "the archive does not hold a sweep",
                     "one written with --sweep");
  hdf5::verify(from, file);
  StoredSweep stored;
  stored.status = hdf5::read_string_attribute(from, "status", file);
  stored.complete = hdf5::read_integer_attribute(from, "complete", file) == 1;
  const Handle provenance = open_group(from, "provenance", file);
  stored.origins = ArchiveFile::read_origins(provenance.get(), file);
  const Handle sweep = open_group(from, "sweep", file);
  stored.plan = SweepPlan::of(Json::parse(hdf5::read_text(sweep.get(), "plan", file), file), file);
  for (std::size_t i = 0; i < stored.plan.systems.size(); ++i) {
    const Handle value = open_group(from, path_of(i).c_str(), file);
    stored.reports.push_back(hdf5::has(value.get(), report_name)
                                 ? hdf5::read_text(value.get(), report_name, file)
                                 : std::string());
  }
  return stored;
}

bool is_sweep_archive(const std::string& file) {
  hdf5::silence();
  try {
    return exists(file) &&
           hdf5::read_string_attribute(opened(file).get(), "kind", file) == sweep_archive_kind;
  } catch (const InputError&) {
    return false;
  }
}

bool extract_value(const std::string& file, std::size_t index, const std::string& target) {
  return extract(opened(file).get(), file, index, target);
}

void unpack_sweep(const std::string& file) {
  const StoredSweep stored = read_sweep(file);
  remove_sweep(file);
  const Handle archive = opened(file);
  for (std::size_t i = 0; i < stored.reports.size(); ++i) {
    extract(archive.get(), file, i, value_of_sweep(file, i));
    if (!stored.reports[i].empty()) keep_report(file, stored.plan, i, stored.reports[i]);
  }
  keep_plan(file, stored.plan);  // last: from now on the folder is a sweep's
}

}  // namespace carom::files
