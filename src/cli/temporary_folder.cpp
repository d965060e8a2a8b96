#include "cli/temporary_folder.hpp"

#include <fmt/format.h>
#include <stdlib.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "carom/base/error.hpp"

namespace carom::cli {

TemporaryFolder::TemporaryFolder() {
  std::error_code failed;
  path_ = (std::filesystem::temp_directory_path(failed) / "carom-XXXXXX").string();
  if (failed)
    throw InputError(Place{}, "no folder for temporary files: " + failed.message(),
                     "a folder in TMPDIR");
  if (!::mkdtemp(path_.data()))
    throw InputError(fmt::format("cannot make the folder '{}': {}", path_, std::strerror(errno)));
}

TemporaryFolder::TemporaryFolder(const std::string& file)
    : path_((std::filesystem::path(file).parent_path() / ".carom-XXXXXX").string()) {
  if (!::mkdtemp(path_.data()))
    throw InputError(fmt::format("cannot write '{}': {}", file, std::strerror(errno)));
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace carom::cli
