#include "io/file_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "carom/base/error.hpp"
#include "carom/io/archive.hpp"
#include "io/ensemble_files.hpp"

namespace carom {

namespace {

std::string lock_of(const std::string& file) { return file + ".lock"; }

// 0 or the error. A signal in between is none.
int lock(int descriptor, int operation) {
  for (;;) {
    if (::flock(descriptor, operation) == 0) return 0;
    if (errno != EINTR) return errno;
  }
}

// Without the mark at its end; "" for a name that has none, and for one that is nothing else.
std::string without(const std::string& mark, const std::string& file) {
  if (!file.ends_with(mark)) return {};
  const std::string rest = file.substr(0, file.size() - mark.size());
  return rest.ends_with('/') ? std::string() : rest;
}

// The archives beside which a file of this name stands: of q.h5.part.new these are q.h5.part and q.h5.
std::vector<std::string> owners_of(std::string file) {
  std::vector<std::string> owners;
  for (bool found = true; found;) {
    found = false;
    for (const std::string& mark : {checkpoint_of(""), records_of(""), aside_of("")})
      if (const std::string owner = without(mark, file); !owner.empty()) {
        owners.push_back(file = owner);
        found = true;
      }
  }
  return owners;
}

}  // namespace

FileLock::FileLock(const std::string& file) : FileLock(file, Kind::alone) {
  const auto refuse = [&](const std::string& problem, const char* expected) {
    throw InputError(Place{file, 0, 0, ""}, problem, expected);
  };
  constexpr const char* in_use = "another process writes it";
  constexpr const char* later = "another name, or the end of that process";
  if (const std::string owner = without(lock_of(""), file); !owner.empty())
    refuse(fmt::format("this is the name of the lock of '{}'", owner), "another name");
  if (!take()) refuse(in_use, later);
  if (is_file_of_others())
    throw InputError(Place{path_, 0, 0, ""}, "the lock of '" + file + "' would go here, and this is another file", "another name");
  for (const std::string& owner : owners_of(file)) {
    std::unique_ptr<FileLock> beside(new FileLock(owner, Kind::beside));
    if (!beside->take()) refuse(fmt::format("{}, for it is a file of '{}'", in_use, owner), later);
    if (!beside->is_file_of_others()) owners_.push_back(std::move(beside));  // else nobody can hold it
  }
}

FileLock::FileLock(const std::string& file, Kind kind) : path_(lock_of(file)), kind_(kind) {}

bool FileLock::is_file_of_others() const {
  struct stat about {};
  return ::stat(path_.c_str(), &about) == 0 && !(S_ISREG(about.st_mode) && about.st_size == 0);
}

// Who lets go removes the file. So a lock counts only on the file that still has the name: another process may
// have opened the file before it was removed, and a third one made the next.
bool FileLock::take() {
  for (;;) {
    descriptor_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    // Another user's file may be read alone, and locked even so.
    if (descriptor_ < 0 && errno == EACCES) descriptor_ = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor_ < 0) return true;  // what cannot be written there will say so itself
    const int operation = kind_ == Kind::alone ? LOCK_EX : LOCK_SH;
    const int error = lock(descriptor_, operation | LOCK_NB);
    const bool held = error == EWOULDBLOCK, there = is_there();
    if (there && !held) {
      if (error != 0) weakness_ = std::strerror(error);  // ENOLCK, EOPNOTSUPP, ENOSYS …: it cannot be known who else writes
      return true;
    }
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

// Of those who write beside an archive the last one removes the file: nobody else holds it then.
FileLock::~FileLock() {
  if (descriptor_ < 0) return;
  const bool shared = kind_ == Kind::beside && lock(descriptor_, LOCK_EX | LOCK_NB) == EWOULDBLOCK;
  if (!shared && is_there() && !is_file_of_others()) ::unlink(path_.c_str());
  ::close(descriptor_);
}

// Before there is anything beside it.
ArchiveLock lock_archive(const std::string& file) {
  refuse_no_file(file);
  return std::make_shared<FileLock>(file);
}

std::string weakness_of(const ArchiveLock& lock) { return lock ? lock->weakness() : std::string(); }

}  // namespace carom
