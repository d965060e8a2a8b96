// What every archive has in common: the file itself, /system, /provenance, the way it is closed.
#pragma once

#include <string>
#include <vector>

#include "carom/events/decisions.hpp"
#include "carom/files/archive.hpp"
#include "files/hdf5/checksums.hpp"
#include "files/hdf5/hdf5.hpp"

namespace carom::files {

/// Time of the computing alone.
struct Seconds {
  double wall = 0.0, cpu = 0.0;
};

class ArchiveFile {
 public:
  /// Creates `path` (which is removed again unless kept) for the archive called `name` in messages.
  static ArchiveFile create(const std::string& path, const std::string& name);
  /// Opens an existing file for changes.
  static ArchiveFile open(const std::string& path, const std::string& name);
  /// Begins the archive `name`, aside, with its head. Takes its lock unless it is given one. Throws
  /// InputError where the file exists and `force` is not set.
  static ArchiveFile begin(const char* kind, const std::string& name, const LoadedSystem&,
                           const Provenance&, bool force, ArchiveLock&);
  ArchiveFile(ArchiveFile&&) noexcept;
  ArchiveFile& operator=(ArchiveFile&&) = delete;
  ~ArchiveFile();

  hid_t id() const { return file_.get(); }
  const std::string& name() const { return name_; }
  hdf5::Handle group(const char* path, const char* description) const;
  hdf5::Handle open_group(const char* path) const;

  /// /system, /provenance, root attributes schema, kind, system, complete = 0 and status "running".
  void write_head(const char* kind, const LoadedSystem&, const Provenance&) const;
  /// A run that goes on: replaces /system, adds the new command to /provenance, complete = 0.
  void extend_head(const LoadedSystem&, const Provenance&) const;
  /// What /provenance says of each part of a run.
  static std::vector<Origin> read_origins(hid_t provenance, const std::string& name);
  void start_swmr() const;
  void set_status(const std::string& status, bool complete) const;
  /// How long the computing took, in /provenance: of all parts of a run.
  void write_seconds(const Seconds&) const;
  static Seconds read_seconds(hid_t provenance, const std::string& name);
  /// Adds the counts of decisions to those of earlier parts of the run in /provenance.
  void add_decisions(const DecisionCounts&) const;

  /// Writes the checksums of all it holds, closes, syncs and renames to `target` (may be the path
  /// itself).
  void keep_as(const std::string& target);
  /// Sets the status, keeps it by its name, and removes what an ensemble of this name has left.
  void finish(const std::string& status, bool complete);
  /// Columns that are closed with it need not be read again for their checksums.
  hdf5::KnownSums* sums() { return &sums_; }

 private:
  ArchiveFile(hdf5::Handle file, std::string path, std::string name);
  hdf5::Handle file_;
  std::string path_, name_;
  hdf5::KnownSums sums_;
  bool kept_ = false;
};

/// Group /walls: names, kinds, ends, centres, semi-axes and angles.
void write_walls(const ArchiveFile&, const Table&);

inline constexpr int archive_schema = 1;
/// Opens an archive for reading. Throws InputError where there is no file, where HDF5 cannot read
/// it (with this problem and what was expected), or where its schema is another one.
hdf5::Handle open_archive(const std::string& name, const std::string& problem,
                          const std::string& expected);
/// An archive that is complete; InputError for anything else.
hdf5::Handle open_finished(const std::string& name);
/// The same, of this kind and not damaged; where it is of another kind, InputError with this
/// problem and what was expected.
hdf5::Handle open_kind(const std::string& name, const std::string& kind, const std::string& problem,
                       const std::string& expected);
/// A group of an archive that is read; InputError where it is missing.
hdf5::Handle open_group(hid_t file, const char* group, const std::string& name);
inline constexpr const char *run_archive_kind = "run", *section_archive_kind = "section",
                            *certified_archive_kind = "certified";
/// Of a run, in /provenance: which trajectory of the ensemble it is.
inline constexpr const char* trajectory_key = "trajectory";

/// What every archive says of itself: those members that the two have.
template <class Stored, class Result>
void read_head(hid_t file, const std::string& name, Stored& stored, Result& result) {
  const hdf5::Handle provenance = open_group(file, "provenance", name);
  const hid_t from = provenance.get();
  stored.system_toml = hdf5::read_text(file, "system", name);
  stored.system_name = hdf5::read_string_attribute(from, "system", name);
  if constexpr (requires { stored.status; })
    stored.status = hdf5::read_string_attribute(file, "status", name);
  if constexpr (requires { stored.engine; })
    stored.engine = hdf5::read_string_attribute(from, "engine", name);
  if constexpr (requires { result.complete; })
    result.complete = hdf5::read_attribute<std::int64_t>(file, "complete", name) != 0;
  if constexpr (requires { result.threads; })
    result.threads = static_cast<int>(hdf5::read_attribute<std::int64_t>(from, "threads", name));
  if constexpr (requires { result.cpu_seconds; }) {
    const Seconds seconds = ArchiveFile::read_seconds(from, name);
    result.seconds = seconds.wall;
    result.cpu_seconds = seconds.cpu;
  }
}

}  // namespace carom::files
