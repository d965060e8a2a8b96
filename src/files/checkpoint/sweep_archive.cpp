#include "files/checkpoint/sweep_archive.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <span>
#include <string_view>
#include <system_error>

#include "carom/base/error.hpp"
#include "carom/base/exact_number.hpp"
#include "carom/files/ensembles.hpp"
#include "files/checkpoint/ensemble_columns.hpp"
#include "files/checkpoint/work_folder.hpp"
#include "files/hdf5/archive_file.hpp"
#include "files/hdf5/checksums.hpp"

namespace carom::files {

using hdf5::Handle;

namespace {

namespace fs = std::filesystem;

constexpr const char *sweep_kind = "sweep", *written = "written", *option_list = "options";

std::string plan_of(const std::string& file) { return folder_of(file) + "/sweep"; }
std::string group_of(std::size_t index) { return fmt::format("values/{}", index); }

void write_plan(const ArchiveFile& file, const SweepPlan& plan) {
  const std::string& name = file.name();
  const Handle group = file.group("sweep", "The table: a row for each value of /values");
  const Handle texts = file.group("sweep/written", "The values of each key, as they are written");
  std::vector<std::string> keys, options;
  for (std::size_t k = 0; k < plan.keys.size(); ++k) {
    const char* const key = plan.keys[k].key.c_str();
    keys.emplace_back(key);
    hdf5::write_texts(texts.get(), key, plan.keys[k].values,
                      {"those of the key", "Its values, in their order"}, name);
    std::vector<double> values;
    for (std::size_t i = 0; i < plan.systems.size(); ++i)
      values.push_back(ExactNumber(plan.at(i)[k]).to_double());
    hdf5::write_column(group.get(), key, std::span<const double>(values),
                       {"those of the key", "What the key was set to"}, name);
  }
  for (const auto& [option, text] : plan.options) options.push_back(option + "=" + text);
  hdf5::write_attribute(group.get(), "keys", keys, name);
  hdf5::write_attribute(group.get(), "command", std::string_view(plan.command), name);
  if (!options.empty()) hdf5::write_attribute(group.get(), option_list, options, name);
}

SweepPlan read_plan(hid_t file, const std::string& name) {
  const Handle group = open_group(file, "sweep", name), values = open_group(file, "values", name),
               texts = open_group(group.get(), written, name);
  SweepPlan plan;
  plan.command = hdf5::read_string_attribute(group.get(), "command", name);
  plan.system_name =
      hdf5::read_string_attribute(open_group(file, "provenance", name).get(), "system", name);
  plan.system_toml = hdf5::read_text(file, "system", name);
  for (const std::string& key : hdf5::read_string_list_attribute(group.get(), "keys", name))
    plan.keys.push_back({key, hdf5::read_texts(texts.get(), key.c_str(), name)});
  for (const std::string& option :
       hdf5::read_string_list_attribute(group.get(), option_list, name)) {
    const std::size_t equals = option.find('=');
    if (equals != std::string::npos)
      plan.options.emplace_back(option.substr(0, equals), option.substr(equals + 1));
  }
  for (std::size_t i = 0; i < plan.points(); ++i)
    plan.systems.push_back(
        hdf5::read_text(open_group(file, group_of(i).c_str(), name).get(), "system", name));
  return plan;
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
void copy_archive(const std::string& name, hid_t to) {
  const Handle archive = open_finished(name), root = open_group(archive.get(), ".", name);
  const hid_t from = root.get();
  copy_attributes(from, to, name);
  H5G_info_t info;
  hdf5::check(H5Gget_info(from, &info) >= 0, name);
  for (hsize_t i = 0; i < info.nlinks; ++i) {
    std::vector<char> link(256);
    const ssize_t length = H5Lget_name_by_idx(from, ".", H5_INDEX_NAME, H5_ITER_INC, i, link.data(),
                                              link.size(), H5P_DEFAULT);
    hdf5::check(length > 0 && static_cast<std::size_t>(length) < link.size(), name);
    hdf5::check(H5Ocopy(from, link.data(), to, link.data(), H5P_DEFAULT, H5P_DEFAULT) >= 0, name);
  }
}

// A value without an archive has its system alone.
void write_value(const ArchiveFile& file, const SweepPlan& plan, std::size_t index,
                 const std::string& archive) {
  const Handle group =
      file.group(group_of(index).c_str(), "A value: all that its archive holds by itself");
  if (exists(archive))
    copy_archive(archive, group.get());
  else
    hdf5::write_text(group.get(), "system", plan.systems[index],
                     {"TOML", "The complete resolved system: carom runs it again"}, file.name());
}

ArchiveFile begun(const std::string& file, const SweepPlan& plan, const Provenance& origin) {
  hdf5::silence();
  ArchiveFile made = ArchiveFile::create(aside_of(file), file);
  made.write_head(sweep_kind, plan.base(), origin);
  write_plan(made, plan);
  made.group("values", "The values of the sweep, from 0 on");
  return made;
}

}  // namespace

std::size_t SweepPlan::points() const {
  std::size_t points = 1;
  for (const SweptKey& key : keys) points *= key.values.size();
  return points;
}

std::vector<std::string> SweepPlan::at(std::size_t index) const {
  std::vector<std::string> values(keys.size());
  for (std::size_t k = keys.size(); k-- > 0;) {
    values[k] = keys[k].values[index % keys[k].values.size()];
    index /= keys[k].values.size();
  }
  return values;
}

std::string SweepPlan::named(std::size_t index) const {
  const std::vector<std::string> values = at(index);
  std::string text;
  for (std::size_t k = 0; k < values.size(); ++k)
    text += fmt::format("{}{} = {}", k == 0 ? "" : ", ", keys[k].key, values[k]);
  return text;
}

LoadedSystem SweepPlan::base() const {
  SystemOverrides without_step;  // which trial runs would have to choose
  without_step.choose_step = false;
  return read_system(system_toml, system_name, without_step);
}

std::string part_of_sweep(const std::string& file, std::size_t index) {
  return fmt::format("{}/value-{}", folder_of(file), index);
}

std::string value_of_sweep(const std::string& file, std::size_t index) {
  return file + "/" + group_of(index);
}

void refuse_other_value(std::size_t index, const std::string& planned, const std::string& toml,
                        const std::string& archive) {
  // As this build writes it: that of an earlier one may lack keys.
  const LoadedSystem now = read_system(planned, archive + ": /system");
  std::vector<std::string> open{"run.window"};
  // A step that the program chose may have been halved since.
  if (now.system.dynamics.integrator.step_chosen) open.emplace_back("integrator.step");
  if (const std::string differs = difference(now.resolved_toml, toml, open); !differs.empty())
    throw InputError(Place{archive, 0, 0, ""},
                     fmt::format("it is not value {} of the sweep: {}", index + 1, differs),
                     "a sweep as carom wrote it");
}

void keep_plan(const std::string& file, const SweepPlan& plan) {
  ArchiveFile made = begun(file, plan, {});
  for (std::size_t i = 0; i < plan.systems.size(); ++i) write_value(made, plan, i, "");
  made.keep_as(plan_of(file));
}

bool has_sweep(const std::string& file) { return has_work_folder(file) && exists(plan_of(file)); }

void check_parts(const std::string& file, const SweepPlan& plan) {
  hdf5::silence();
  for (std::size_t i = 0; i < plan.systems.size(); ++i) {
    const std::string part = part_of_sweep(file, i);
    if (!is_complete(part)) continue;  // a run that was killed begins anew
    const Handle archive = open_finished(part);
    hdf5::verify(archive.get(), part);
    refuse_other_value(i, plan.systems[i], hdf5::read_text(archive.get(), "system", part), part);
  }
}

void write_sweep(const std::string& file, const SweepPlan& plan,
                 const std::vector<SweepNumbers>& table, const Provenance& origin,
                 const std::string& status, bool complete) {
  {
    ArchiveFile made = begun(file, plan, origin);
    const Handle group = made.open_group("sweep");
    for (const SweepNumbers& column : table)
      hdf5::write_column(group.get(), column.name.c_str(), std::span<const double>(column.values),
                         {"as in the report", "As in the reports; NaN: none"}, file);
    for (std::size_t i = 0; i < plan.systems.size(); ++i)
      write_value(made, plan, i, part_of_sweep(file, i));
    made.set_status(status, complete);
    made.keep_as(file);
  }
  remove_sweep(file);
}

StoredSweep read_sweep(const std::string& file) {
  const std::string name = has_sweep(file) ? plan_of(file) : file;
  const Handle archive = open_finished(name);
  const hid_t from = archive.get();
  if (hdf5::read_string_attribute(from, "kind", name) != sweep_kind)
    throw InputError(Place{name, 0, 0, ""}, "the archive does not hold a sweep",
                     "one written with --sweep");
  hdf5::verify(from, name);
  StoredSweep stored;
  stored.plan = read_plan(from, name);
  stored.status = hdf5::read_string_attribute(from, "status", name);
  stored.complete = hdf5::read_attribute<std::int64_t>(from, "complete", name) == 1;
  stored.origins = ArchiveFile::read_origins(open_group(from, "provenance", name).get(), name);
  for (std::size_t i = 0; i < stored.plan.systems.size(); ++i)
    if (hdf5::has(open_group(from, group_of(i).c_str(), name).get(), "provenance"))
      stored.computed.push_back(i);
  return stored;
}

bool is_sweep_archive(const std::string& file) {
  try {
    return exists(file) && kind_of_archive(file) == sweep_kind;
  } catch (const InputError&) {
    return false;
  }
}

void extract_value(const std::string& value, const std::string& target) {
  ArchiveFile made = ArchiveFile::create(target, target);
  const Handle root = open_group(made.id(), ".", target);
  copy_archive(value, root.get());
  hdf5::check(H5Adelete(root.get(), "description") >= 0, target);  // the sweep's own
  hdf5::verify(made.id(), value);  // the checksums are those of the value when it was computed
  made.keep_as(target);
}

void unpack_sweep(const std::string& file) {
  const StoredSweep stored = read_sweep(file);
  remove_sweep(file);
  for (const std::size_t i : stored.computed)
    extract_value(value_of_sweep(file, i), part_of_sweep(file, i));
  keep_plan(file, stored.plan);  // last: from now on the folder is a sweep's
}

void remove_sweep(const std::string& file) {
  if (!has_work_folder(file)) return;
  std::error_code error;
  fs::remove(plan_of(file), error);
  std::vector<fs::path> values;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_of(file), error))
    if (entry.path().filename().string().starts_with("value-")) values.push_back(entry.path());
  for (const fs::path& value : values) fs::remove_all(value, error);
}

}  // namespace carom::files
