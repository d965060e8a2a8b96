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
inline constexpr const char *run_archive_kind = "run", *section_archive_kind = "section",
                            *certified_archive_kind = "certified";
/// Of a run, in /provenance: which trajectory of the ensemble it is.
inline constexpr const char* trajectory_key = "trajectory";

}  // namespace carom::files
