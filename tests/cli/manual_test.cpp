// The man page and the completions of shells, made from the table of commands, against --help.
#include <gtest/gtest.h>

#include <regex>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "cli/program.hpp"

namespace carom {
namespace {

const std::string manual = CAROM_BUILD "/manual";

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

// The first words of the indented lines below `title` in a help text, up to an empty line:
// "-o,--output", "escape".
std::vector<std::string> listed(const std::string& help, const std::string& title) {
  std::vector<std::string> names;
  std::istringstream lines(help.substr(std::min(help.size(), help.find("\n" + title + ":\n") + 1)));
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line) && !line.empty())
    if (line.starts_with("  ") && line[2] != ' ') names.push_back(words_of(line).at(0));
  return names;
}

std::vector<std::string> commands() {
  const Shell shell;
  return listed(shell("$carom --help").out, "Subcommands");
}

// "-o,--output": both.
std::vector<std::string> options_of(const std::string& command) {
  const Shell shell;
  std::vector<std::string> names;
  for (std::string one : listed(shell("$carom " + command + " --help").out, "Options"))
    for (const std::string& name : words_of(std::regex_replace(one, std::regex(","), " ")))
      names.push_back(name);
  return names;
}

// The page without marks of roff.
std::string man_page() {
  const Shell shell;
  std::string page = shell.read(manual + "/carom.1");
  page = std::regex_replace(page, std::regex(R"(\\f[BIR])"), "");
  return std::regex_replace(page, std::regex(R"(\\-)"), "-");
}

// From a heading to the next one.
std::string part(const std::string& page, const std::string& heading) {
  const std::size_t at = page.find(heading + "\n");
  if (at == std::string::npos) return {};
  const std::size_t end = page.find("\n.S", at + heading.size());
  return page.substr(at, end - at);
}

bool has_word(const std::string& text, const std::string& word) {
  return std::regex_search(text, std::regex("(^|[ \n])" + word + "([,. \n]|$)"));
}

TEST(ManPage, HasEveryCommandAndOption) {
  const std::string page = man_page();
  const std::string common = part(page, ".SH COMMON OPTIONS");
  ASSERT_NE(common, "");
  const std::vector<std::string> all = commands();
  ASSERT_GE(all.size(), 9u);
  for (const std::string& command : all) {
    const std::string own = part(page, ".SS \"carom " + command + "\"");
    ASSERT_NE(own, "") << command;
    const std::size_t shared = own.find("Common options: ");
    const std::vector<std::string> options = options_of(command);
    ASSERT_GE(options.size(), 3u) << command;
    for (const std::string& option : options) {
      // Explained here; or named here by its long name, and explained among the common ones.
      const bool here = has_word(own.substr(0, shared), option);
      EXPECT_TRUE(here || has_word(common, option)) << command << " " << option;
      if (option.starts_with("--")) {
        EXPECT_TRUE(has_word(own, option)) << command << " " << option;
      }
    }
  }
}

TEST(ManPage, HasTheSystemsAndTheStatuses) {
  const std::string page = man_page();
  const Shell shell;
  const std::string systems = part(page, ".SH BUILT-IN SYSTEMS");
  int found = 0;
  std::istringstream lines(shell("$carom systems").out);
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with("  ") && !line.starts_with("   ")) {  // not the rest of a title
      ++found;
      EXPECT_TRUE(has_word(systems, words_of(line).at(0))) << line;
    }
  EXPECT_GE(found, 16);
  for (const char* status : {"0", "1", "2", "3", "130"})
    EXPECT_TRUE(has_word(part(page, ".SH EXIT STATUS"), status)) << status;
}

TEST(ManPage, IsSetWithoutAWarning) {
  const Shell shell;
  if (shell("command -v groff").status != 0) GTEST_SKIP() << "no groff";
  const Outcome o = shell("groff -man -Tutf8 -ww -z " + manual + "/carom.1");
  EXPECT_EQ(o.status, 0);
  EXPECT_EQ(o.err, "");
  const std::string set = shell("groff -man -Tutf8 -P-cbou " + manual + "/carom.1").out;
  EXPECT_NE(set.find("Solanpää"), std::string::npos);
  EXPECT_NE(set.find("--trust-tolerance X"), std::string::npos);
}

// What bash offers when TAB is typed at the end of the line.
std::string offered(const Shell& shell, const std::string& line) {
  // bash splits words at "=" and ":", too.
  const std::string words = std::regex_replace(line, std::regex("[=:]"), " $& ");
  const std::string last = line.ends_with(' ') || line.ends_with('=') ? " \"\"" : "";
  const Outcome o = shell("bash -c 'source " + manual + "/carom; COMP_WORDS=(" + words +
                          (line.ends_with('=') ? "" : last) +
                          "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _carom; "
                          "echo \"${COMPREPLY[@]}\"'");
  EXPECT_EQ(o.err, "") << line;
  return o.out.substr(0, o.out.find_last_not_of(" \n") + 1);
}

TEST(Completion, OfBashOffersWhatFits) {
  const Shell shell;
  shell("mkdir sub; touch my.toml orbit.h5 note.txt 'two words.toml'");
  const std::pair<const char*, const char*> cases[] = {
      {"carom es", "escape"},
      {"carom s", "section schemes systems"},
      {"carom --v", "--version"},
      {"carom help di", "diffusion"},
      {"carom escape mu", "mushroom"},
      {"carom escape m", "magnetic-square mushroom my.toml"},
      {"carom escape --seed 3 m", "magnetic-square mushroom my.toml"},
      {"carom escape --seed=3 m", "magnetic-square mushroom my.toml"},
      {"carom escape --times log:1:100:5 mu", "mushroom"},
      {"carom escape --times log:1", ""},
      {"carom escape stadium m", ""},
      {"carom escape su", "sub"},
      {"carom escape t", "three-disc two words.toml"},
      {"carom escape --seed ", ""},
      {"carom escape stadium --spl", "--splitting"},
      {"carom run stadium --precision ", "double certified"},
      {"carom run stadium --precision=c", "certified"},
      {"carom run stadium --precision=", "double certified"},
      {"carom section stadium --direction p", "positive"},
      {"carom run --resume o", "orbit.h5"},
      {"carom run stadium -o n", "note.txt"},
      {"carom plot o", "orbit.h5"},
      {"carom plot n", ""},
      {"carom merge all.h5 or", "orbit.h5"},
      {"carom systems st", "stadium"},
      {"carom systems my", ""},
      {"carom nothing m", ""}};
  for (const auto& [line, candidates] : cases) EXPECT_EQ(offered(shell, line), candidates) << line;
  EXPECT_EQ(words_of(offered(shell, "carom ")).size(), commands().size() + 1);  // and help
}

TEST(Completion, OffersEveryOptionOfHelp) {
  const Shell shell;
  const std::string zsh = shell.read(manual + "/_carom");
  for (const std::string& command : commands()) {
    EXPECT_EQ(words_of(offered(shell, "carom " + command + " -")), options_of(command)) << command;
    const std::size_t begin = zsh.find("\n    " + command + ")\n");
    ASSERT_NE(begin, std::string::npos) << command;
    const std::string own = zsh.substr(begin, zsh.find(";;", begin) - begin);
    for (const std::string& option : options_of(command))
      EXPECT_NE(own.find("'" + option + (option == "--set" ? "=" : "")), std::string::npos)
          << command << " " << option;
  }
}

TEST(Completion, OfZshIsValid) {
  const Shell shell;
  if (shell("command -v zsh").status != 0) GTEST_SKIP() << "no zsh";
  const Outcome o = shell("zsh -n " + manual + "/_carom");
  EXPECT_EQ(o.status, 0);
  EXPECT_EQ(o.err, "");
}

}  // namespace
}  // namespace carom
