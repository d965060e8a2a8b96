// A folder for temporary files that its owner removes.
#pragma once

#include <string>

namespace carom::cli {

class TemporaryFolder {
 public:
  /// In TMPDIR, or where the system keeps temporary files. Throws InputError if it cannot be made.
  TemporaryFolder();
  /// Beside `file`, which then can be made in it and renamed.
  explicit TemporaryFolder(const std::string& file);
  TemporaryFolder(const TemporaryFolder&) = delete;
  ~TemporaryFolder();
  std::string file(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

}  // namespace carom::cli
