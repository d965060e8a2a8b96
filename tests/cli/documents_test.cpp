// The commands that README, guide and help show do what they promise.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include "program.hpp"

namespace carom {
namespace {

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

// What a user is told to type: "./dev run ARGS" or "carom ARGS" at the start of a line, without its
// archive.
std::vector<std::string> commands_of(const std::string& text) {
  std::vector<std::string> commands;
  const std::regex shown("(?:^|\n) *(?:\\./dev run|carom) ((?:[^\n]*\\\\\n)*[^\n]*)");
  for (std::sregex_iterator at(text.begin(), text.end(), shown), end; at != end; ++at) {
    std::string command = std::regex_replace((*at)[1].str(), std::regex("\\\\\n *"), "");
    command = std::regex_replace(command, std::regex(" +#.*|   +.*"), "");
    commands.push_back(std::regex_replace(command, std::regex(" -o [^ ]+"), ""));
  }
  return commands;
}

std::vector<std::string> all_commands() {
  const Shell shell;
  std::string text = text_of(std::filesystem::path(CAROM_SOURCE) / "README.md");
  for (const char* folder : {"docs/guide", "docs/guide/commands"})
    for (const auto& page :
         std::filesystem::directory_iterator(std::filesystem::path(CAROM_SOURCE) / folder))
      if (page.path().extension() == ".md") text += "\n" + text_of(page.path());
  for (const char* help : {"--help", "run --help", "section --help"})
    text += "\n" + shell(std::string("$carom ") + help).out;
  return commands_of(text);
}

// A hole would end most of these runs after a few hits.
TEST(Documents, RunsMakeTheHitsTheyAskFor) {
  const Shell shell;
  int tried = 0;
  const std::regex cap("--collisions ([^ ]+)");
  for (const std::string& command : all_commands()) {
    std::smatch collisions;
    if (!command.starts_with("run ") || !std::regex_search(command, collisions, cap)) continue;
    if (command.find("--resume") != std::string::npos ||
        command.find("--precision") != std::string::npos)
      continue;
    ++tried;
    const Outcome o = shell("$carom " + command + " --json");
    EXPECT_EQ(o.status, 0) << command << o.err;
    EXPECT_EQ(std::strtod(json_value(o.out, "collisions").c_str(), nullptr),
              std::strtod(collisions[1].str().c_str(), nullptr))
        << command;
  }
  EXPECT_GE(tried, 5);
}

// So would it end orbits before their points are full, and a section by a wall that is not there
// has none.
TEST(Documents, SectionsHaveTheirPoints) {
  const Shell shell;
  int tried = 0;
  for (const std::string& command : all_commands()) {
    if (!command.starts_with("section ") || command.find("henon") != std::string::npos) continue;
    ++tried;
    const std::string few = std::regex_replace(command, std::regex(" --(orbits [0-9]+|json)"), "");
    const Outcome o = shell("$carom " + few + " --json --orbits 5");
    EXPECT_EQ(o.status, 0) << command << o.err;
    EXPECT_EQ(json_value(o.out, "escaped"), "0") << command;
    if (command.find("--points") != std::string::npos) {
      EXPECT_EQ(json_value(o.out, "incomplete"), "0") << command;
    }
  }
  EXPECT_GE(tried, 4);
}

}  // namespace
}  // namespace carom
