// A folder that goes with its owner.
#pragma once

#include <string>

namespace carom::cli {

class TemporaryFolder {
 public:
  /// Below TMPDIR. Throws InputError where it cannot be made.
  TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  ~TemporaryFolder();
  std::string file(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

}  // namespace carom::cli
