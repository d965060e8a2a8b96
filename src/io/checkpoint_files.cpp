// What stands beside FILE.h5: its checkpoint and records, or files of others, which are left alone.
#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>

#include "carom/base/error.hpp"
#include "io/ensemble_files.hpp"

namespace carom {

using hdf5::Handle;

namespace {

bool is_ensemble(const std::string& kind) { return kind == kind_of(EscapeResult()) || kind == kind_of(DiffusionResult()); }

struct Running {
  std::string kind;
  bool names_records = false;
};

// What a checkpoint holds; nothing for any other file. An archive that ended is no checkpoint, whatever its name.
std::optional<Running> read_running(const std::string& path) {
  if (!exists(path)) return {};
  hdf5::silence();
  const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file) return {};
  try {
    const std::string kind = hdf5::read_string_attribute(file.get(), "kind", path);
    const bool running = hdf5::read_string_attribute(file.get(), "status", path) == "running" &&
                         hdf5::read_integer_attribute(file.get(), "complete", path) == 0;
    if (!running || !is_ensemble(kind)) return {};
    return Running{kind, H5Lexists(file.get(), "records", H5P_DEFAULT) > 0};
  } catch (const InputError&) {
    return {};
  }
}

bool begins_as_hdf5(const std::string& path) {
  constexpr std::array<char, 8> signature{'\x89', 'H', 'D', 'F', '\r', '\n', '\x1a', '\n'};
  std::array<char, 8> begin{};
  std::ifstream(path, std::ios::binary).read(begin.data(), begin.size());
  return begin == signature;
}

bool is_empty(const std::string& path) {
  std::error_code error;
  return std::filesystem::file_size(path, error) == 0 && !error;
}

}  // namespace

bool exists(const std::string& file) {
  std::error_code ignored;
  return std::filesystem::exists(file, ignored);
}

bool is_checkpoint(const std::string& path) { return read_running(path).has_value(); }
bool has_checkpoint(const std::string& file) { return is_checkpoint(checkpoint_of(file)); }

std::string archive_named(const std::string& name) {
  const std::string mark = checkpoint_of("");
  if (!name.ends_with(mark)) return name;
  const bool nothing_there = !exists(name) && !exists(checkpoint_of(name));
  return nothing_there || is_checkpoint(name) ? name.substr(0, name.size() - mark.size()) : name;
}

bool has_records(const std::string& file) {
  const std::optional<Running> running = read_running(checkpoint_of(file));
  return running && running->names_records;
}

std::string stored_in(const std::string& file) {
  const std::string checkpoint = checkpoint_of(file);
  if (is_checkpoint(checkpoint)) return checkpoint;
  // What begins as an archive and is no checkpoint belongs to another name. Anything else may be a damaged checkpoint.
  return !exists(file) && exists(checkpoint) && !begins_as_hdf5(checkpoint) ? checkpoint : file;
}

// The records first: without a checkpoint nobody knows whose they are.
void remove_checkpoint(const std::string& file) {
  const std::string checkpoint = checkpoint_of(file);
  const std::optional<Running> running = read_running(checkpoint);
  if (!running) return;
  if (running->names_records) std::remove(records_of(file).c_str());
  std::remove((checkpoint + ".new").c_str());
  std::remove(checkpoint.c_str());
}

void refuse_files_of_others(const std::string& file, bool force) {
  const std::string checkpoint = checkpoint_of(file), records = records_of(file);
  const std::optional<Running> running = read_running(checkpoint);
  const auto refuse = [](const std::string& name, const std::string& problem, const char* expected) {
    throw InputError(Place{name, 0, 0, ""}, problem, expected);
  };
  if (!running && exists(checkpoint)) {
    if (begins_as_hdf5(checkpoint))
      refuse(checkpoint, fmt::format("the checkpoint of '{}' would go here, and this is another file", file), "another name");
    if (!force)
      refuse(checkpoint, fmt::format("the checkpoint of '{}' would go here, and this is none", file), "another name, or --force");
  }
  const bool of_nobody = !(running && running->names_records) && exists(records) && !is_empty(records);
  if (of_nobody && !force)
    refuse(records, fmt::format("the records of '{}' would go here, and there is no checkpoint that this belongs to", file),
           "another name, or --force");
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
