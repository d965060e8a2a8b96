// Archives (HDF5): what they have in common. docs/guide/archive.md is the schema.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "carom/files/system_file.hpp"

namespace carom::files {
class WorkFolder;
}  // namespace carom::files

namespace carom {

/// Once, before anything else happens in the program.
void prepare_archives();

/// Throws InputError where `file` exists and `force` is not set, and where it is no file: a folder,
/// a device, a pipe.
void refuse_existing(const std::string& file, bool force);
/// Is there an ensemble of this name that has not ended?
bool has_checkpoint(const std::string& file);

/// For the process that holds the lock of `file`: removes its checkpoint, if it has one, and the
/// records that this names.
void remove_checkpoint(const std::string& file);
/// The file behind a name: symbolic links are followed, to a file that is not there yet, too, so
/// that what is beside an archive is beside the file and not beside the link. Throws
/// InputError where links lead round.
std::string followed(const std::string& name);
/// The archive that a user means: FILE for the name of its folder FILE.part.
std::string archive_named(const std::string& name);
/// Throws InputError where FILE is in the folder in which another archive is made.
void refuse_inside(const std::string& file);

/// As long as it lives, no other process writes the archive. It holds the folder FILE.part, in
/// which FILE is made.
using ArchiveLock = std::shared_ptr<files::WorkFolder>;
/// Throws InputError where another process writes it, where it is no file, and where FILE.part is
/// something else. Archives take their lock themselves, unless they are given one that was taken
/// before something was read.
ArchiveLock lock_archive(const std::string& file);
/// Why the file system gives no lock ("No locks available"), so that other processes are not kept
/// away; "" if it does.
std::string weakness_of(const ArchiveLock&);

/// The run that made a part of a result.
struct Origin {
  std::string command, version, date;
};

/// Where a result comes from. Everything else of /provenance is known to the archive.
struct Provenance {
  std::string command;  ///< as typed
  std::string engine, isa;
  int threads = 1;
  std::vector<Origin> before;  ///< of the parts that came before
};

/// What an archive holds: "run", "escape", "diffusion", "section", … Throws InputError for anything
/// else.
std::string kind_of_archive(const std::string& file);

}  // namespace carom
