#include "files/checkpoint/work_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <memory>

#include "carom/base/error.hpp"
#include "carom/files/archive.hpp"
#include "files/checkpoint/rank_parts.hpp"
#include "files/checkpoint/sweep_archive.hpp"
#include "files/platform.hpp"

namespace carom {

using namespace files;

namespace fs = std::filesystem;

namespace {

constexpr const char* lock_name = "carom.lock";
std::string lock_of(const std::string& file) { return folder_of(file) + "/" + lock_name; }

// 0 or the error. A signal in between is none.
int try_lock(int descriptor) {
  for (;;) {
    if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0) return 0;
    if (errno != EINTR) return errno;
  }
}

// A folder is on the disk only after this. Where it cannot be synced, what is written into it says
// so.
void sync_folder_with(const std::string& file) {
  const fs::path folder = fs::path(file).parent_path();
  const int descriptor =
      ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  sync_all(descriptor);
  ::close(descriptor);
}

// Is the file that is open still the one of that name?
bool is_there(int descriptor, const std::string& path) {
  struct stat mine {
  }, named{};
  return ::fstat(descriptor, &mine) == 0 && ::stat(path.c_str(), &named) == 0 &&
         mine.st_ino == named.st_ino && mine.st_dev == named.st_dev;
}

// Is it there, and nothing that Carom made? One listing tells: in a folder of Carom's the lock
// comes first and goes last. What other processes remove meanwhile is no stranger.
bool is_strange(const std::string& folder) {
  std::error_code error;
  const fs::file_status status = fs::symlink_status(folder, error);
  if (!fs::exists(status)) return false;
  if (!fs::is_directory(status)) return true;
  bool any = false;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().filename() == lock_name) {
      const fs::file_status lock = entry.symlink_status(error);
      return fs::exists(lock) && !fs::is_regular_file(lock);
    }
    any = true;
  }
  return any;
}

}  // namespace

bool files::has_work_folder(const std::string& file) {
  std::error_code error;
  const std::string folder = folder_of(file);
  return fs::is_directory(fs::symlink_status(folder, error)) && !is_strange(folder);
}

WorkFolder::WorkFolder(const std::string& file) : file_(file), lock_(lock_of(file)) {
  const std::string folder = folder_of(file);
  // Other processes may remove the folder at any time: then it is made anew.
  for (;;) {
    const bool made = ::mkdir(folder.c_str(), 0777) == 0;
    if (!made && errno != EEXIST)
      throw InputError(fmt::format("cannot write '{}': {}", file, std::strerror(errno)));
    if (made) sync_folder_with(folder);
    if (is_strange(folder))
      throw InputError(Place{folder, 0, 0, ""},
                       fmt::format("'{}' would be made here, and this is something else", file),
                       "another name");
    if (!open_lock()) continue;
    const int error = try_lock(descriptor_);
    const bool held = error == EWOULDBLOCK, there = is_there(descriptor_, lock_);
    if (there && !held) {
      if (error != 0)
        weakness_ =
            std::strerror(error);  // ENOLCK, EOPNOTSUPP, ENOSYS …: another process may write
      return;
    }
    ::close(descriptor_);
    if (there)
      throw InputError(Place{file, 0, 0, ""}, "another process writes it",
                       "another name, or the end of that process");
  }
}

bool WorkFolder::open_lock() {
  constexpr int own = O_CREAT | O_NOFOLLOW | O_CLOEXEC;
  descriptor_ = ::open(lock_.c_str(), O_RDWR | own, 0666);
  // Another user's file may be read alone, and locked even so.
  if (descriptor_ < 0 && errno == EACCES)
    descriptor_ = ::open(lock_.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
  if (descriptor_ >= 0) return true;
  if (errno == ENOENT) return false;
  const std::string reason = std::strerror(errno);
  ::rmdir(folder_of(file_).c_str());  // empty, where it was made just now
  throw InputError(fmt::format("cannot write '{}': {}", file_, reason));
}

// The lock goes last, and with it the folder, where nothing else is in it. It counts only on the
// file that still has the name: another process may have opened it before it was removed.
WorkFolder::~WorkFolder() {
  std::remove(aside_of(file_).c_str());
  if (!exists(checkpoint_of(file_))) std::remove(records_of(file_).c_str());
  std::error_code error;
  const auto entries =
      std::distance(fs::directory_iterator(folder_of(file_), error), fs::directory_iterator());
  if (!error && entries == 1 && is_there(descriptor_, lock_)) {
    ::unlink(lock_.c_str());
    ::rmdir(folder_of(file_).c_str());
  }
  ::close(descriptor_);
}

bool files::exists(const std::string& file) {
  std::error_code ignored;
  return fs::exists(file, ignored);
}

bool files::is_empty(const std::string& path) {
  std::error_code error;
  return fs::file_size(path, error) == 0 && !error;
}

int files::create_file(const std::string& path) {
  if (::unlink(path.c_str()) != 0 && errno != ENOENT) return -1;
  return ::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
}

bool files::write_new_file(const std::string& path, std::string_view bytes, bool synced) {
  const int descriptor = create_file(path);
  if (descriptor < 0) return false;
  bool ok = true;
  for (std::size_t at = 0; ok && at < bytes.size();) {
    const ssize_t count = ::write(descriptor, bytes.data() + at, bytes.size() - at);
    if (count < 0 && errno == EINTR) continue;
    ok = count > 0;
    if (ok) at += static_cast<std::size_t>(count);
  }
  ok = ok && (!synced || sync_all(descriptor));
  const int error = errno;
  ok = ::close(descriptor) == 0 && ok;
  if (!ok) errno = error;
  return ok;
}

bool files::is_no_file(const std::string& path) {
  std::error_code ignored;
  return exists(path) && !fs::is_regular_file(path, ignored);
}

void files::refuse_no_file(const std::string& file) {
  if (!is_no_file(file)) return;
  std::error_code ignored;
  throw InputError(Place{file, 0, 0, ""},
                   fs::is_directory(file, ignored) ? "the output is a directory"
                                                   : "the output is a device or a pipe",
                   "the name of a file");
}

ArchiveLock lock_archive(const std::string& file) {
  refuse_no_file(file);
  return std::make_shared<WorkFolder>(file);
}

std::string weakness_of(const ArchiveLock& lock) { return lock ? lock->weakness() : std::string(); }

void refuse_inside(const std::string& file) {
  const std::string folder = fs::path(file).parent_path().string(), mark = folder_of("");
  if (!folder.ends_with(mark)) return;
  const std::string owner = folder.substr(0, folder.size() - mark.size());
  if (has_work_folder(owner))
    throw InputError(Place{file, 0, 0, ""},
                     fmt::format("this is in the folder in which '{}' is made", owner),
                     "a name in another folder");
}

bool has_checkpoint(const std::string& file) {
  return has_work_folder(file) && exists(checkpoint_of(file));
}

// Removes the records, too: without a checkpoint they mean nothing.
void remove_checkpoint(const std::string& file) {
  std::remove(checkpoint_of(file).c_str());
  std::remove(records_of(file).c_str());
}

void files::give_up_checkpoint(const std::string& file) {
  remove_checkpoint(file);
  remove_sweep(file);
  std::error_code ignored;
  for (const std::string& part : parts_of_ranks(file)) {
    const ArchiveLock lock = lock_archive(part);
    remove_checkpoint(part);
    fs::remove(part, ignored);
  }
}

std::string followed(const std::string& name) {
  constexpr int most = 40;  // as the system has it
  fs::path path = name;
  std::error_code error;
  // Devices keep their names: what links to pipes and closed files hold is none.
  for (int links = 0; fs::is_symlink(path, error) && !is_no_file(path.string()); ++links) {
    if (links == most)
      throw InputError(Place{name, 0, 0, ""}, "it is a link that leads to no file",
                       "the name of a file");
    const fs::path target = fs::read_symlink(path, error);
    if (error) break;
    path = path.parent_path() / target;
  }
  return path.string();
}

std::string archive_named(const std::string& name) {
  const std::string mark = folder_of("");
  std::string folder = name;
  while (folder.size() > 1 && folder.ends_with('/')) folder.pop_back();
  if (!folder.ends_with(mark)) return name;
  const std::string file = folder.substr(0, folder.size() - mark.size());
  const bool nothing_there = !exists(folder) && !exists(folder_of(folder));
  return nothing_there || has_work_folder(file) ? file : name;
}

}  // namespace carom
