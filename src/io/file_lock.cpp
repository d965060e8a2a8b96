#include "io/file_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

#include "carom/base/error.hpp"
#include "carom/io/archive.hpp"

namespace carom {

// Who lets go removes the file. So a lock counts only on the file that still has the name: another process may
// have opened the file before it was removed, and a third one made the next.
FileLock::FileLock(const std::string& file) : path_(file + ".lock") {
  if (!take())
    throw InputError(Place{file, 0, 0, ""}, "another process writes it", "another name, or the end of that process");
  refuse_file_of_others(file);
}

void FileLock::refuse_file_of_others(const std::string& file) {
  struct stat about {};
  if (::stat(path_.c_str(), &about) != 0 || (S_ISREG(about.st_mode) && about.st_size == 0)) return;
  if (descriptor_ >= 0) ::close(descriptor_);
  throw InputError(Place{path_, 0, 0, ""}, "the lock of '" + file + "' would go here, and this is another file", "another name");
}

bool FileLock::take() {
  for (;;) {
    descriptor_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    // Another user's file may be read alone, and locked even so.
    if (descriptor_ < 0 && errno == EACCES) descriptor_ = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor_ < 0) return true;  // what cannot be written there will say so itself
    const bool held = ::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    const bool there = is_there();
    if (there && !held) return true;
    ::close(descriptor_);
    descriptor_ = -1;
    if (there) return false;
  }
}

bool FileLock::is_there() const {
  struct stat mine {}, named {};
  return ::fstat(descriptor_, &mine) == 0 && ::stat(path_.c_str(), &named) == 0 && mine.st_ino == named.st_ino &&
         mine.st_dev == named.st_dev;
}

FileLock::~FileLock() {
  if (descriptor_ < 0) return;
  ::unlink(path_.c_str());
  ::close(descriptor_);
}

ArchiveLock lock_archive(const std::string& file) { return std::make_shared<FileLock>(file); }

}  // namespace carom
