// FILE.part, the folder in which an archive FILE is made: everything that is beside FILE is
// in it.
#pragma once

#include <string>
#include <string_view>

namespace carom::files {

inline std::string folder_of(const std::string& file) { return file + ".part"; }
/// An archive by itself, always whole: what an ensemble has done so far.
inline std::string checkpoint_of(const std::string& file) {
  return folder_of(file) + "/checkpoint.h5";
}
/// The records of the trajectories that the checkpoint counts.
inline std::string records_of(const std::string& file) { return folder_of(file) + "/records"; }
/// A new checkpoint or archive, which is renamed when it is whole.
inline std::string aside_of(const std::string& file) { return folder_of(file) + "/new"; }

/// Claims FILE.part as long as it lives, and makes it where it is not there. A killed process
/// leaves the folder, but not the claim. In the end the folder goes, unless it holds a checkpoint
/// or shares of ranks.
class WorkFolder {
 public:
  /// Throws InputError where another process holds it, where something else has that name, and
  /// where it cannot be made. Where the file system gives no locks nothing is held: see weakness().
  explicit WorkFolder(const std::string& file);
  WorkFolder(const WorkFolder&) = delete;
  ~WorkFolder();
  /// Why no other process is kept away, as the system says it; "" where they are.
  const std::string& weakness() const { return weakness_; }

 private:
  bool open_lock();  // false: another process has just removed it
  std::string file_, lock_;
  int descriptor_ = -1;
  std::string weakness_;
};

/// Is FILE.part such a folder? It holds a lock, or nothing.
bool has_work_folder(const std::string& file);

/// Called by the process that holds the lock of FILE: removes its checkpoint, the shares of
/// ranks, and what a sweep has left.
void give_up_checkpoint(const std::string& file);

bool exists(const std::string& file);
bool is_empty(const std::string& file);
/// Is there something of this name that is no file: a device, a pipe, a folder? Nothing replaces
/// it, and nothing reads it.
bool is_no_file(const std::string& path);
/// A descriptor of a new file of this name, which may be read and written; -1 and errno where it
/// cannot be made. What had the name before is removed, and never followed: in a folder that others
/// may write to, it may be a link to a file of the user's.
int create_file(const std::string& path);
/// A new file of this name with these bytes; false and errno where that fails. `synced`: they are
/// on the disk then.
bool write_new_file(const std::string& path, std::string_view bytes, bool synced = false);
/// Throws InputError where `file`, which is to be written, is no file.
void refuse_no_file(const std::string& file);

}  // namespace carom::files
