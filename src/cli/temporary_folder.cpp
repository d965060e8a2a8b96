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
  const char* const folder = ::getenv("TMPDIR");
  path_ = fmt::format("{}/carom-XXXXXX", folder ? folder : "/tmp");
  if (!::mkdtemp(path_.data()))
    throw InputError(fmt::format("cannot make the folder '{}': {}", path_, std::strerror(errno)));
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace carom::cli
