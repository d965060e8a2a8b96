#include "files/platform.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <string>
#include <system_error>
#if defined(__APPLE__)
#include <mach-o/dyld.h>
#endif

namespace carom::files {

namespace portable {

std::filesystem::path path_of_program(int (*ask)(char* path, std::uint32_t* size)) {
  std::uint32_t size = 256;
  std::string path(size, '\0');
  if (ask(path.data(), &size) != 0) {
    path.assign(size, '\0');
    if (ask(path.data(), &size) != 0) return {};
  }
  std::error_code error;
  return std::filesystem::canonical(path.c_str(), error);  // empty, if it fails
}

bool sync(int descriptor, int full) {
  return ::fcntl(descriptor, full) == 0 || ::fsync(descriptor) == 0;
}

}  // namespace portable

#if defined(__APPLE__)

std::filesystem::path path_of_program() { return portable::path_of_program(_NSGetExecutablePath); }
bool sync_contents(int descriptor) { return portable::sync(descriptor, F_FULLFSYNC); }
bool sync_all(int descriptor) { return portable::sync(descriptor, F_FULLFSYNC); }

#else

std::filesystem::path path_of_program() {
  std::error_code error;
  return std::filesystem::read_symlink("/proc/self/exe", error);
}
bool sync_contents(int descriptor) { return ::fdatasync(descriptor) == 0; }
bool sync_all(int descriptor) { return ::fsync(descriptor) == 0; }

#endif

}  // namespace carom::files
