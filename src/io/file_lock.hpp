// One writer at a time.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace carom {

/// Holds FILE.lock as long as it lives. A killed process leaves the file behind, but not the lock. Where FILE has the name of a
/// file that stands beside an archive, as its checkpoint does, it keeps others from that archive, too, and throws if one
/// writes it; those who write beside the same archive do not disturb each other.
class FileLock {
 public:
  /// Throws InputError if another process holds it, if FILE.lock is a file of somebody else (a lock's file is empty), and if
  /// FILE itself has the name of a lock. Where the file system gives no locks, nothing is held: see weakness().
  explicit FileLock(const std::string& file);
  FileLock(const FileLock&) = delete;
  ~FileLock();
  /// Why nobody else is kept away, as the system says it; "" where they are.
  const std::string& weakness() const { return weakness_; }

 private:
  enum class Kind { alone, beside };
  FileLock(const std::string& file, Kind kind);
  bool take();  // false: another one holds it
  /// Is the file that is open still the one of that name?
  bool is_there() const;
  bool is_file_of_others() const;

  std::string path_;
  Kind kind_;
  int descriptor_ = -1;
  std::string weakness_;
  std::vector<std::unique_ptr<FileLock>> owners_;  ///< of the archives beside which FILE stands
};

}  // namespace carom
