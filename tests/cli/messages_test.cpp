// Messages of faults, word by word: messages.txt holds each fault and the whole message that
// follows.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

#include "carom/files/system_file.hpp"
#include "cli/program.hpp"

namespace carom {
namespace {

const std::string path = CAROM_SOURCE "/tests/cli/messages.txt";

std::string message_of_system(std::string text) {
  const std::string square = "<square>";
  if (text.starts_with(square))
    text.replace(0, square.size(), "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1");
  try {
    read_system(text, "test.toml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no fault";
}

// "STATUS$ line of the shell". A single command that fails prints the message alone and leaves no
// file.
std::string message_of_command(const std::string& line) {
  const Shell shell;
  const Outcome o = shell("carom() { $carom \"$@\"; }; " + line.substr(3));
  EXPECT_EQ(std::to_string(o.status), line.substr(0, 1)) << line;
  if (line.find_first_of(";|&") == std::string::npos) {
    EXPECT_EQ(o.out, "") << line;
    EXPECT_TRUE(shell.files().empty()) << line;
  }
  return o.err.substr(0, o.err.find_last_not_of('\n') + 1);
}

bool is_command(const std::string& line) { return line.size() > 3 && line.substr(1, 2) == "$ "; }

/// The message as it stands in the file, "> " before each line.
std::string quoted(const std::string& message) {
  std::string result;
  std::istringstream lines(message);
  for (std::string line; std::getline(lines, line);) result += "> " + line + "\n";
  return result;
}

TEST(Messages, AreThoseOfTheFile) {
  std::ifstream file(path);
  ASSERT_TRUE(file);
  std::string input, expected, anew;
  int cases = 0;
  const auto compare = [&] {
    if (expected.empty()) return;
    ++cases;
    const std::string message =
        quoted(is_command(input) ? message_of_command(input.substr(0, input.find('\n')))
                                 : message_of_system(input));
    EXPECT_EQ(message, expected) << "of\n" << input;
    anew += message;
    input.clear();
    expected.clear();
  };
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("> ")) {
      expected += line + "\n";
      continue;
    }
    compare();
    anew += line + "\n";
    if (!line.empty() && !line.starts_with("#")) input += line + "\n";
  }
  compare();
  EXPECT_GT(cases, 200);
  if (std::getenv("CAROM_WRITE_MESSAGES")) std::ofstream(path) << anew;
}

}  // namespace
}  // namespace carom
