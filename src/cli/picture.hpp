// Pictures are drawn by the Python module, which reads what the program has written.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/options.hpp"
#include "cli/temporary_folder.hpp"

namespace carom::cli {

/// Does the name end in .png, .svg or .pdf?
bool is_picture(const std::string& file);
/// Throws InputError where it does not.
void refuse_other_endings(const std::string& file);

/// The picture of an archive or a system; `words`: options of carom.picture. Returns the exit
/// status. Throws InputError where Python, the module or matplotlib is not there, and says which
/// package it is in.
int draw(const std::string& source, const std::string& picture, bool force,
         const std::vector<std::string>& words = {});

/// A command that is asked for a picture writes an archive aside, which is drawn when it is done.
class PictureOfResult {
 public:
  /// Takes the picture's name out of `options`. Throws InputError for other endings than those of
  /// archives and pictures.
  explicit PictureOfResult(Options& options);
  /// Draws, if there is something to draw: not after bad input. The text of the command names the
  /// picture. Returns the exit status, given that of the command.
  int finish(int status) const;

 private:
  std::string picture_;
  bool force_ = false, json_ = false;
  std::optional<TemporaryFolder> folder_;
};

}  // namespace carom::cli
