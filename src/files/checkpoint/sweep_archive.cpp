#include "files/checkpoint/sweep_archive.hpp"

#include <fmt/format.h>

#include <span>
#include <string_view>
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

constexpr const char* report_name = "report";

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

// To a group that has none of these names. HDF5's own copy of a group with many attributes that are
// texts of variable length crashes (1.10): attributes go one by one.
void copy_attributes(hid_t from, hid_t to, const std::string& name) {
  const int count = H5Aget_num_attrs(from);
  hdf5::check(count >= 0, name);
  for (int i = 0; i < count; ++i) {
    const Handle attribute(H5Aopen_by_idx(from, ".", H5_INDEX_NAME, H5_ITER_INC,
                                          static_cast<hsize_t>(i), H5P_DEFAULT, H5P_DEFAULT),
                           H5Aclose);
    hdf5::check(bool(attribute), name);
    const Handle type(H5Aget_type(attribute.get()), H5Tclose),
        space(H5Aget_space(attribute.get()), H5Sclose);
    const hssize_t points = H5Sget_simple_extent_npoints(space.get());
    const ssize_t length = H5Aget_name(attribute.get(), 0, nullptr);
    hdf5::check(type && points >= 0 && length > 0, name);
    std::vector<char> key(static_cast<std::size_t>(length) + 1),
        value(static_cast<std::size_t>(points) * H5Tget_size(type.get()));
    hdf5::check(H5Aget_name(attribute.get(), key.size(), key.data()) == length, name);
    const Handle copy(H5Acreate2(to, key.data(), type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
                      H5Aclose);
    hdf5::check(copy && H5Aread(attribute.get(), type.get(), value.data()) >= 0 &&
                    H5Awrite(copy.get(), type.get(), value.data()) >= 0,
                name);
    if (H5Tis_variable_str(type.get()) > 0)
      H5Dvlen_reclaim(type.get(), space.get(), H5P_DEFAULT, value.data());
  }
}

// All of an archive as a group of another file, or such a group as an archive.
void copy_archive(hid_t from, hid_t to, const std::string& name) {
  copy_attributes(from, to, name);
  H5G_info_t info;
  hdf5::check(H5Gget_info(from, &info) >= 0, name);
  for (hsize_t i = 0; i < info.nlinks; ++i) {
    std::vector<char> link(256);
    const ssize_t length = H5Lget_name_by_idx(from, ".", H5_INDEX_NAME, H5_ITER_INC, i, link.data(),
                                              link.size(), H5P_DEFAULT);
    hdf5::check(length > 0 && static_cast<std::size_t>(length) < link.size(), name);
    if (std::string_view(link.data()) == report_name) continue;  // the sweep's own
    hdf5::check(H5Ocopy(from, link.data(), to, link.data(), H5P_DEFAULT, H5P_DEFAULT) >= 0, name);
  }
}

void write_value(const ArchiveFile& file, const SweepPlan& plan, std::size_t index) {
  const std::string &name = file.name(), path = path_of(index);
  const Handle group = file.group(path.c_str(), "A value: its archive, and its report");
  if (const auto report = kept_report(name, plan, index))
    hdf5::write_text(group.get(), report_name, *report,
                     {"JSON", "What the command prints of it with --json"}, name);
  const std::string archive = value_of_sweep(name, index);
  if (!exists(archive)) return;
  const Handle from = opened(archive);
  copy_archive(open_group(from.get(), "/", archive).get(), group.get(), archive);
}

bool extract(hid_t file, const std::string& name, std::size_t index, const std::string& target) {
  const Handle value = open_group(file, path_of(index).c_str(), name);
  if (!hdf5::has(value.get(), "provenance")) return false;
  ArchiveFile made = ArchiveFile::create(target, target);
  const Handle root = open_group(made.id(), "/", target);
  copy_archive(value.get(), root.get(), name);
  hdf5::check(H5Adelete(root.get(), "description") >= 0, target);  // the sweep's own
  hdf5::verify(made.id(), name);  // the checksums are those of the value when it was computed
  made.keep_as(target);
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
