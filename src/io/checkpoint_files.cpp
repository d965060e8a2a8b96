// What stands beside FILE.h5: its checkpoint and records, or files of others, which are left alone.
#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>
#include <utility>

#include "carom/base/error.hpp"
#include "io/ensemble_files.hpp"

namespace carom {

using hdf5::Handle;

namespace {

bool is_ensemble(const std::string& kind) { return kind == kind_of(EscapeResult()) || kind == kind_of(DiffusionResult()); }

// What a file of such a name is. Nothing but `other` may be replaced by whom it stands in the way of.
struct Found {
  enum class What {
    nothing,     ///< there is no file, or an empty one
    unfinished,  ///< an archive that has not ended
    damaged,     ///< begins as HDF5, or as a file of it that was never closed, and cannot be read
    whole,       ///< an archive that ended, or an HDF5 file of anybody
    other        ///< anything else
  } what = What::nothing;
  std::string kind = {};
  bool names_records = false;
};

// Data are written before the head is, so that of a file that was never closed the head may be zero.
bool may_be_hdf5(const std::string& path) {
  constexpr std::array<char, 8> signature{'\x89', 'H', 'D', 'F', '\r', '\n', '\x1a', '\n'};
  std::array<char, 8> begin{};
  std::ifstream(path, std::ios::binary).read(begin.data(), begin.size());
  return begin == signature || begin == std::array<char, 8>{};
}

Found look_at(const std::string& path) {
  using What = Found::What;
  if (is_no_file(path)) return {What::other};
  if (!exists(path) || is_empty(path)) return {};
  if (!may_be_hdf5(path)) return {What::other};
  hdf5::silence();
  const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file) return {What::damaged};
  const htri_t has_kind = H5Aexists(file.get(), "kind");
  if (has_kind <= 0) return {has_kind == 0 ? What::whole : What::damaged};
  try {
    const std::string kind = hdf5::read_string_attribute(file.get(), "kind", path);
    const bool running = hdf5::read_string_attribute(file.get(), "status", path) == "running" &&
                         hdf5::read_integer_attribute(file.get(), "complete", path) == 0;
    return {running ? What::unfinished : What::whole, kind, H5Lexists(file.get(), "records", H5P_DEFAULT) > 0};
  } catch (const InputError&) {
    return {What::damaged};
  }
}

// What a checkpoint holds; nothing for any other file. An archive that ended is no checkpoint, whatever its name.
std::optional<Found> read_running(const std::string& path) {
  Found found = look_at(path);
  if (found.what != Found::What::unfinished || !is_ensemble(found.kind)) return {};
  return found;
}

[[noreturn]] void refuse(const std::string& name, const std::string& problem, bool force_helps) {
  throw InputError(Place{name, 0, 0, ""}, problem, force_helps ? "another name, or --force" : "another name");
}

// Was it left by a process that was killed while it wrote there? A whole archive, too, beside the checkpoint that it was to
// replace.
bool is_left_over(const std::string& aside, const std::string& checkpoint) {
  using What = Found::What;
  const What what = look_at(aside).what;
  return what == What::unfinished || what == What::damaged || (what == What::whole && is_checkpoint(checkpoint));
}

}  // namespace

bool exists(const std::string& file) {
  std::error_code ignored;
  return std::filesystem::exists(file, ignored);
}

bool is_empty(const std::string& path) {
  std::error_code error;
  return std::filesystem::file_size(path, error) == 0 && !error;
}

bool is_no_file(const std::string& path) {
  std::error_code ignored;
  return exists(path) && !std::filesystem::is_regular_file(path, ignored);
}

void refuse_no_file(const std::string& file) {
  if (!is_no_file(file)) return;
  std::error_code ignored;
  const bool folder = std::filesystem::is_directory(file, ignored);
  throw InputError(Place{file, 0, 0, ""}, folder ? "the output is a directory" : "the output is a device or a pipe", "the name of a file");
}

bool is_checkpoint(const std::string& path) { return read_running(path).has_value(); }
bool has_checkpoint(const std::string& file) { return is_checkpoint(checkpoint_of(file)); }

std::string followed(const std::string& name) {
  constexpr int most = 40;  // as the system has it
  std::filesystem::path path = name;
  std::error_code error;
  // Devices keep their names: what links to pipes and closed files hold is none.
  for (int links = 0; std::filesystem::is_symlink(path, error) && !is_no_file(path.string()); ++links) {
    if (links == most) throw InputError(Place{name, 0, 0, ""}, "it is a link that leads to no file", "the name of a file");
    const std::filesystem::path target = std::filesystem::read_symlink(path, error);
    if (error) break;
    path = path.parent_path() / target;
  }
  return path.string();
}

std::string archive_named(const std::string& name) {
  const std::string mark = checkpoint_of("");
  if (!name.ends_with(mark)) return name;
  const bool nothing_there = !exists(name) && !exists(checkpoint_of(name));
  return nothing_there || is_checkpoint(name) ? name.substr(0, name.size() - mark.size()) : name;
}

bool has_records(const std::string& file) {
  const std::optional<Found> running = read_running(checkpoint_of(file));
  return running && running->names_records;
}

std::string stored_in(const std::string& file) {
  const std::string checkpoint = checkpoint_of(file);
  if (is_checkpoint(checkpoint)) return checkpoint;
  // A whole archive that is no checkpoint belongs to another name. Anything else may be a damaged checkpoint.
  return !exists(file) && exists(checkpoint) && look_at(checkpoint).what != Found::What::whole ? checkpoint : file;
}

// The records first: without a checkpoint nobody knows whose they are.
void remove_checkpoint(const std::string& file) {
  const std::string checkpoint = checkpoint_of(file);
  const std::optional<Found> running = read_running(checkpoint);
  if (!running) return;
  if (running->names_records) std::remove(records_of(file).c_str());
  if (is_left_over(aside_of(checkpoint), checkpoint)) std::remove(aside_of(checkpoint).c_str());
  std::remove(checkpoint.c_str());
}

void refuse_aside_of_others(const std::string& file, const std::string& aside, bool force) {
  const bool no_file = is_no_file(aside);
  if (!no_file && (force || !exists(aside) || is_empty(aside) || is_left_over(aside, checkpoint_of(file)))) return;
  refuse(aside, fmt::format("'{}' would be written here first, and this is {}", file, no_file ? "no file" : "another file"), !no_file);
}

void refuse_files_of_others(const std::string& file, bool force) {
  const std::string checkpoint = checkpoint_of(file), records = records_of(file);
  for (const auto& [path, what] : {std::pair(checkpoint, "checkpoint"), std::pair(records, "records")})
    if (is_no_file(path)) refuse(path, fmt::format("the {} of '{}' would go here, and this is no file", what, file), false);
  const Found found = look_at(checkpoint);
  const bool running = found.what == Found::What::unfinished && is_ensemble(found.kind);
  if (!running && exists(checkpoint)) {
    if (found.what == Found::What::whole || found.what == Found::What::unfinished)
      refuse(checkpoint, fmt::format("the checkpoint of '{}' would go here, and this is another file", file), false);
    if (!force) refuse(checkpoint, fmt::format("the checkpoint of '{}' would go here, and this is none", file), true);
  }
  const bool of_nobody = !(running && found.names_records) && exists(records) && !is_empty(records);
  if (of_nobody && !force)
    refuse(records, fmt::format("the records of '{}' would go here, and there is no checkpoint that this belongs to", file), true);
  refuse_aside_of_others(file, aside_of(checkpoint), force);
}

std::string kind_of_ensemble(const std::string& file) {
  hdf5::silence();
  const std::string name = stored_in(file);
  const std::string kind = hdf5::read_string_attribute(open_ensemble(name).get(), "kind", name);
  if (!is_ensemble(kind))
    throw InputError(Place{name, 0, 0, ""}, "the archive does not hold an ensemble",
                     "one written by carom escape or carom diffusion");
  return kind;
}

}  // namespace carom
