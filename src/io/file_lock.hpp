// One writer at a time.
#pragma once

#include <string>

namespace carom {

/// Holds FILE.lock as long as it lives. A killed process leaves the file behind, but not the lock.
class FileLock {
 public:
  /// Throws InputError if another process holds it, or if FILE.lock is a file of somebody else: a lock's file is empty.
  /// Where the file system knows no locks, nothing is held.
  explicit FileLock(const std::string& file);
  FileLock(const FileLock&) = delete;
  ~FileLock();

 private:
  bool take();  // false: another one holds it
  /// Is the file that is open still the one of that name?
  bool is_there() const;
  void refuse_file_of_others(const std::string& file);

  std::string path_;
  int descriptor_ = -1;
};

}  // namespace carom
