#include "files/hdf5/archive_file.hpp"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <filesystem>

#include "carom/base/error.hpp"
#include "carom/files/ensembles.hpp"
#include "carom_version.hpp"
#include "files/checkpoint/rank_parts.hpp"
#include "files/checkpoint/sweep_archive.hpp"
#include "files/checkpoint/work_folder.hpp"
#include "files/platform.hpp"

namespace carom {

using namespace files;
using hdf5::Handle;

namespace {

constexpr const char *running = "running", *seconds_key = "seconds",
                     *cpu_seconds_key = "cpu_seconds";

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(now));
}

// Data are on the disk only after this; a full disk may show only here.
void sync(const std::string& path, int flags, const std::string& name) {
  const int descriptor = ::open(path.c_str(), flags);
  const bool ok = descriptor >= 0 && sync_all(descriptor);
  const int error = errno;
  if (descriptor >= 0) ::close(descriptor);
  if (!ok) throw InputError(fmt::format("cannot write '{}': {}", name, std::strerror(error)));
}

// HDF5 would empty a file before it sees that another program has it open. It locks by flock.
void refuse_open_elsewhere(const std::string& path, const std::string& name) {
  const int descriptor = ::open(path.c_str(), O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return;  // it is not there, or cannot be written: that is said later
  const bool is_open = ::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(descriptor);
  if (is_open)
    throw InputError(Place{name, 0, 0, ""}, "another program has it open",
                     "another name, or the end of that program");
}

Handle latest_format(const std::string& name) {
  Handle access = hdf5::checked(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, name);
  hdf5::check(H5Pset_libver_bounds(access.get(), H5F_LIBVER_LATEST, H5F_LIBVER_LATEST) >= 0, name);
  return access;
}

// Attributes stay in the headers of their objects, which have checksums. HDF5 would move them to a
// heap where there are more than eight, and reads beyond its end where that is damaged.
Handle attributes_in_headers(const std::string& name) {
  Handle creation = hdf5::checked(H5Pcreate(H5P_GROUP_CREATE), H5Pclose, name);
  constexpr unsigned all = 65535;
  hdf5::check(H5Pset_attr_phase_change(creation.get(), all, 0) >= 0, name);
  return creation;
}

// Names from the second part on: command_2, command_3, …
std::string numbered(const char* what, std::size_t part) {
  return part == 1 ? what : fmt::format("{}_{}", what, part);
}

void write_origin(hid_t provenance, std::size_t part, const Origin& origin,
                  const std::string& name) {
  const auto write = [&](const char* what, const std::string& text) {
    hdf5::write_attribute(provenance, numbered(what, part).c_str(), std::string_view(text), name);
  };
  write("command", origin.command);
  write("version", origin.version);
  write("date", origin.date);
}

}  // namespace

void prepare_archives() { hdf5::prepare(); }

void refuse_existing(const std::string& file, bool force) {
  refuse_no_file(file);
  if (!force && exists(file))
    throw InputError(Place{file, 0, 0, ""}, "the output file exists already",
                     "another name, or --force");
  if (force || (!has_checkpoint(file) && parts_of_ranks(file).empty() && !has_sweep(file))) return;
  std::string command = "carom";
  try {
    command += " " + (has_sweep(file) ? read_sweep(file).plan.command : kind_of_ensemble(file));
  } catch (const InputError&) {  // it is damaged: --resume says in what
  }
  throw InputError(
      Place{file, 0, 0, ""}, "a run that has not ended left a checkpoint of this name",
      fmt::format("{} --resume {} to continue it, another name, or --force", command, file));
}

ArchiveFile::ArchiveFile(Handle file, std::string path, std::string name)
    : file_(std::move(file)), path_(std::move(path)), name_(std::move(name)) {}

ArchiveFile::ArchiveFile(ArchiveFile&& other) noexcept
    : file_(std::move(other.file_)),
      path_(std::move(other.path_)),
      name_(std::move(other.name_)),
      sums_(std::move(other.sums_)),
      kept_(std::exchange(other.kept_, true)) {}

ArchiveFile::~ArchiveFile() {
  if (kept_) return;
  file_.close();
  std::remove(path_.c_str());
}

ArchiveFile ArchiveFile::create(const std::string& path, const std::string& name) {
  refuse_open_elsewhere(path, name);
  const Handle access = latest_format(name);
  errno = 0;
  // As create_file, by HDF5's own open.
  H5Eclear2(H5E_DEFAULT);
  Handle file;
  if (::unlink(path.c_str()) == 0 || errno == ENOENT)
    file = Handle(H5Fcreate(path.c_str(), H5F_ACC_EXCL, H5P_DEFAULT, access.get()), H5Fclose);
  if (!file) {
    const int error = errno;
    if (is_empty(path)) std::remove(path.c_str());  // it was begun, and there was no room
    errno = error;
  }
  hdf5::check(bool(file), name);
  return ArchiveFile(std::move(file), path, name);
}

ArchiveFile ArchiveFile::open(const std::string& path, const std::string& name) {
  const Handle access = latest_format(name);
  errno = 0;
  Handle file = hdf5::checked(H5Fopen(path.c_str(), H5F_ACC_RDWR, access.get()), H5Fclose, name);
  return ArchiveFile(std::move(file), path, name);
}

ArchiveFile ArchiveFile::begin(const char* kind, const std::string& name,
                               const LoadedSystem& loaded, const Provenance& origin, bool force,
                               ArchiveLock& lock) {
  if (!lock) lock = lock_archive(name);
  refuse_existing(name, force);
  hdf5::silence();
  ArchiveFile file = create(aside_of(name), name);
  file.write_head(kind, loaded, origin);
  return file;
}

Handle ArchiveFile::group(const char* path, const char* description) const {
  const Handle creation = attributes_in_headers(name_);
  Handle group = hdf5::checked(H5Gcreate2(id(), path, H5P_DEFAULT, creation.get(), H5P_DEFAULT),
                               H5Gclose, name_);
  hdf5::write_attribute(group.get(), "description", std::string_view(description), name_);
  return group;
}

Handle ArchiveFile::open_group(const char* path) const {
  return hdf5::checked(H5Gopen2(id(), path, H5P_DEFAULT), H5Gclose, name_);
}

void ArchiveFile::write_head(const char* kind, const LoadedSystem& loaded,
                             const Provenance& origin) const {
  hdf5::write_attribute(id(), "schema", std::int64_t{archive_schema}, name_);
  hdf5::write_attribute(id(), "kind", std::string_view(kind), name_);
  hdf5::write_attribute(id(), "complete", std::int64_t{0}, name_);
  hdf5::write_attribute(id(), "status", std::string_view(running), name_);
  hdf5::write_text(id(), "system", loaded.resolved_toml,
                   {"TOML", "The complete resolved system: carom runs it again"}, name_);
  write_walls(*this, *loaded.system.table);
  const Handle provenance = group("provenance", "Where this result comes from");
  const hid_t to = provenance.get();
  hdf5::write_attribute(to, "system", std::string_view(loaded.system.name), name_);
  hdf5::write_attribute(to, "compiler", std::string_view(compiler), name_);
  hdf5::write_attribute(to, "seed", loaded.system.run.seed, name_);
  hdf5::write_attribute(to, "engine", std::string_view(origin.engine), name_);
  hdf5::write_attribute(to, "isa", std::string_view(origin.isa), name_);
  hdf5::write_attribute(to, "threads", std::int64_t{origin.threads}, name_);
  std::vector<Origin> parts = origin.before;
  parts.push_back({origin.command, version, utc_now()});
  for (std::size_t i = 0; i < parts.size(); ++i) write_origin(to, i + 1, parts[i], name_);
  hdf5::write_attribute(to, "continued", static_cast<std::int64_t>(origin.before.size()), name_);
  // Beside the results: how a decision was taken changes none of them.
  hdf5::write_attribute(to, "decisions_filter", std::int64_t{0}, name_);
  hdf5::write_attribute(to, "decisions_exact", std::int64_t{0}, name_);
}

void ArchiveFile::extend_head(const LoadedSystem& loaded, const Provenance& origin) const {
  set_status(running, false);
  hdf5::check(H5Ldelete(id(), "system", H5P_DEFAULT) >= 0, name_);
  hdf5::write_text(id(), "system", loaded.resolved_toml,
                   {"TOML", "The complete resolved system: carom runs it again"}, name_);
  const Handle provenance = open_group("provenance");
  const std::int64_t times =
      1 + hdf5::read_attribute<std::int64_t>(provenance.get(), "continued", name_);
  hdf5::change_attribute(provenance.get(), "continued", times, name_);
  write_origin(provenance.get(), static_cast<std::size_t>(times) + 1,
               {origin.command, version, utc_now()}, name_);
}

std::vector<Origin> ArchiveFile::read_origins(hid_t provenance, const std::string& name) {
  std::vector<Origin> parts;
  const std::int64_t continued = hdf5::read_attribute<std::int64_t>(provenance, "continued", name);
  if (continued < 0)
    throw InputError(Place{name, 0, 0, ""}, "'/provenance/continued' is negative",
                     "an archive as carom wrote it");
  const auto times = static_cast<std::size_t>(continued);
  for (std::size_t part = 1; part <= times + 1; ++part) {
    const auto text = [&](const char* what) {
      return hdf5::read_string_attribute(provenance, numbered(what, part).c_str(), name);
    };
    parts.push_back({text("command"), text("version"), text("date")});
  }
  return parts;
}

void ArchiveFile::start_swmr() const {
  hdf5::reserve_checksums(id(), name_);
  hdf5::check(H5Fstart_swmr_write(id()) >= 0, name_);
}

void ArchiveFile::set_status(const std::string& status, bool complete) const {
  hdf5::change_attribute(id(), "status", std::string_view(status), name_);
  hdf5::change_attribute(id(), "complete", std::int64_t{complete}, name_);
}

void ArchiveFile::write_seconds(const Seconds& seconds) const {
  const Handle provenance = open_group("provenance");
  const auto write = [&](const char* name, double value) {
    // The attributes of a run that others read are there before it begins.
    if (H5Aexists(provenance.get(), name) > 0)
      hdf5::change_attribute(provenance.get(), name, value, name_);
    else
      hdf5::write_attribute(provenance.get(), name, value, name_);
  };
  write(seconds_key, seconds.wall);
  write(cpu_seconds_key, seconds.cpu);
}

Seconds ArchiveFile::read_seconds(hid_t provenance, const std::string& name) {
  return {hdf5::read_attribute<double>(provenance, seconds_key, name),
          hdf5::read_attribute<double>(provenance, cpu_seconds_key, name)};
}

void ArchiveFile::add_decisions(const DecisionCounts& counts) const {
  const Handle provenance = open_group("provenance");
  const auto add = [&](const char* name, std::uint64_t number) {
    const std::int64_t before = hdf5::read_attribute<std::int64_t>(provenance.get(), name, name_);
    hdf5::change_attribute(provenance.get(), name, before + static_cast<std::int64_t>(number),
                           name_);
  };
  add("decisions_filter", counts.filter);
  add("decisions_exact", counts.exact);
}

void ArchiveFile::keep_as(const std::string& target) {
  hdf5::write_checksums(id(), name_, sums_);
  hdf5::check(H5Fflush(id(), H5F_SCOPE_GLOBAL) >= 0, name_);
  hdf5::check(file_.close(), name_);
  sync(path_, O_RDONLY, name_);
  if (target != path_ && std::rename(path_.c_str(), target.c_str()) != 0)
    throw InputError(fmt::format("cannot write '{}': {}", name_, std::strerror(errno)));
  path_ = target;
  kept_ = true;  // whatever comes: there is nothing else of that name any more
  const std::filesystem::path folder = std::filesystem::path(target).parent_path();
  sync(folder.empty() ? "." : folder.string(), O_RDONLY | O_DIRECTORY, name_);
}

void ArchiveFile::finish(const std::string& status, bool complete) {
  set_status(status, complete);
  keep_as(name_);
  give_up_checkpoint(name_);
}

hdf5::Handle files::open_archive(const std::string& name, const std::string& problem,
                                 const std::string& expected) {
  const Place place{name, 0, 0, ""};
  // "FILE/values/3": a value of a sweep, which is an archive by itself.
  const std::size_t end =
      exists(name) ? name.size() : std::min(name.rfind("/values/"), name.size());
  const std::string path = name.substr(0, end);
  if (!exists(path)) throw InputError(place, "there is no such file");
  Handle file;  // HDF5 would wait for a pipe
  if (!is_no_file(path))
    file = Handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (file && end < name.size())
    file = Handle(H5Gopen2(file.get(), name.c_str() + end, H5P_DEFAULT), H5Gclose);
  if (!file) throw InputError(place, problem, expected);
  if (hdf5::read_attribute<std::int64_t>(file.get(), "schema", name) != archive_schema)
    throw InputError(place, "the archive has another schema",
                     "one written by this version of carom");
  return file;
}

Handle files::open_finished(const std::string& name) {
  hdf5::silence();
  return open_archive(name, "the file is not an archive, or it is still being written",
                      "an archive of carom");
}

Handle files::open_kind(const std::string& name, const std::string& kind,
                        const std::string& problem, const std::string& expected) {
  Handle file = open_finished(name);
  if (hdf5::read_string_attribute(file.get(), "kind", name) != kind)
    throw InputError(Place{name, 0, 0, ""}, problem, expected);
  hdf5::verify(file.get(), name);
  return file;
}

Handle files::open_group(hid_t file, const char* group, const std::string& name) {
  Handle handle(H5Gopen2(file, group, H5P_DEFAULT), H5Gclose);
  if (!handle)
    throw InputError(Place{name, 0, 0, ""}, fmt::format("'{}' is missing", group),
                     "an archive of an ensemble");
  return handle;
}

std::string kind_of_archive(const std::string& file) {
  return hdf5::read_string_attribute(open_finished(file).get(), "kind", file);
}

}  // namespace carom
