// The two kinds of error: what a user can mend, and what must not happen.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace carom {

/// Where a value was written: file (or "command line", or the name of a built-in system), line and
/// column counted from 1 (0: unknown), and the dotted key, e.g. "table.hole[0].width".
struct Place {
  std::string file;
  int line = 0;
  int column = 0;
  std::string key;
};

/// "file, line L, column C: key" with the unknown parts left out.
std::string describe(const Place& place);

/// Bad input. Thrown while a system is read, a table is built or an archive is opened.
class InputError : public std::runtime_error {
 public:
  /// `problem`: what is wrong; `expected`: what would be right (may be empty);
  /// `nearest`: the nearest valid name (may be empty).
  InputError(Place place, std::string problem, std::string expected = {}, std::string nearest = {});
  explicit InputError(const std::string& problem) : InputError(Place{}, problem) {}
  const Place& place() const { return place_; }
  const std::string& problem() const { return problem_; }
  const std::string& expected() const { return expected_; }
  const std::string& nearest() const { return nearest_; }

 private:
  Place place_;
  std::string problem_, expected_, nearest_;
};

/// A promise inside Carom was broken; never the user's fault.
class InternalError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

/// The candidate nearest to `word` by edit distance, or "" when none is near.
std::string nearest_name(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace carom
