// Runs the program as a user does.
#pragma once

#include <string>
#include <vector>

#include "scratch_folder.hpp"

namespace carom {

struct Outcome {
  int status = -1;  ///< exit status; 128 + signal if killed
  std::string out, err;
};

/// Through the shell, in a folder of this test's own: "carom" stands for the program.
class Shell {
 public:
  /// `command` is a shell line in which $carom is the program. While $pid runs in the background,
  /// `until_there FILE` waits for a file with something in it, `until_saved FILE` for the second
  /// checkpoint of FILE, in which there are trajectories if checkpoints are blocks apart,
  /// `until_listening` until SIGTERM is no longer the end of it.
  Outcome operator()(const std::string& command) const;
  bool exists(const std::string& file) const;
  std::string read(const std::string& file) const;
  /// Names of all files of the folder but the captured output, sorted.
  std::vector<std::string> files() const;
  std::string folder() const { return folder_.path().string(); }

 private:
  ScratchFolder folder_;
};

/// Status 1, nothing on standard output, and a message that begins with this place: a file, or
/// "command line: " and an option or key.
void expect_refused(const Outcome& outcome, const std::string& place);
/// The text with the ends of its lines as blanks: sentences of a report are broken where they are
/// long.
std::string on_one_line(std::string text);
/// Is the text exactly one JSON object (and white space)?
bool is_json_object(const std::string& text);
/// The text of a key's value in an object as this program prints it, "" if there is none.
std::string json_value(const std::string& text, const std::string& key);

}  // namespace carom
