// The man pages and the completions of shells, against --help.
#include <gtest/gtest.h>

#include <regex>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "cli/program.hpp"

namespace carom {
namespace {

const std::string pages = CAROM_BUILD "/man/";
const std::string completion = CAROM_SOURCE "/cmake/completion/";

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
  const std::string help = shell("$carom --help").out;
  std::vector<std::string> all;
  for (const char* group : {"Compute", "Look", "Data and checks"})
    for (const std::string& command : listed(help, group)) all.push_back(command);
  return all;
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

// The page without marks of roff, "" if there is none.
std::string man_page(const std::string& name) {
  const Shell shell;
  std::string page = shell.read(pages + name + ".1");
  page = std::regex_replace(page, std::regex(R"(\\f[BIR])"), "");
  return std::regex_replace(page, std::regex(R"(\\-)"), "-");
}

bool has_word(const std::string& text, const std::string& word) {
  return std::regex_search(text, std::regex("(^|[ \n])" + word + "([,. \n]|$)"));
}

class ManPage : public testing::Test {
 protected:
  void SetUp() override {
    if (man_page("carom").empty()) GTEST_SKIP() << "no help2man";
  }
};

TEST_F(ManPage, HasEveryCommandAndOption) {
  const std::string program = man_page("carom");
  const std::vector<std::string> all = commands();
  ASSERT_GE(all.size(), 9u);
  for (const std::string& command : all) {
    EXPECT_TRUE(has_word(program, command)) << command;
    const std::string page = man_page("carom-" + command);
    EXPECT_NE(page.find("\ncarom-" + command + " - "), std::string::npos) << command;
    for (const std::string& option : options_of(command))
      EXPECT_NE(page.find(option), std::string::npos) << command << " " << option;
    for (const char* status : {"0", "1", "2", "3", "130"})
      EXPECT_NE(page.find(std::string("\n.B ") + status + "\n"), std::string::npos) << status;
  }
}

TEST_F(ManPage, IsSetWithoutAWarning) {
  const Shell shell;
  if (shell("command -v groff").status != 0) GTEST_SKIP() << "no groff";
  const Outcome o =
      shell("for page in " + pages + "*.1; do groff -K utf8 -man -Tutf8 -ww -z $page; done");
  EXPECT_EQ(o.status, 0);
  EXPECT_EQ(o.err, "");
  const std::string set =
      shell("groff -K utf8 -man -Tutf8 -P-cbou " + pages + "carom-compare.1").out;
  EXPECT_NE(set.find("--schemes A,B|all"), std::string::npos);
  EXPECT_NE(set.find("\n              carom compare henon-heiles\n"), std::string::npos);
}

// What bash offers when TAB is typed at the end of the line.
std::string offered(const Shell& shell, const std::string& line) {
  // bash splits words at "=" and ":", too.
  const std::string words = std::regex_replace(line, std::regex("[=:]"), " $& ");
  const Outcome o =
      shell("bash -c 'source " + completion + "carom; COMP_WORDS=(" + words +
            (line.ends_with(' ') ? " \"\"" : "") +
            "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); COMP_LINE=\"" + line +
            "\"; COMP_POINT=${#COMP_LINE}; _carom '$carom'; echo \"${COMPREPLY[@]}\"'");
  EXPECT_EQ(o.err, "") << line;
  return o.out.substr(0, o.out.find_last_not_of(" \n") + 1);
}

TEST(Completion, OfBashOffersWhatFits) {
  const Shell shell;
  shell("mkdir sub; touch my.toml orbit.h5 note.txt 'two words.toml'");
  const std::pair<const char*, const char*> cases[] = {
      {"carom es", "escape"},
      {"carom s", "section systems schemes"},
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
      {"carom run mushroom --set table.st", "table.stem_width= table.stem_height="},
      {"carom run stadium --set=table.hole[0].c", "table.hole[0].center="},
      {"carom run stadium --set table.radius=", ""},
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
  for (const std::string& command : commands())
    EXPECT_EQ(words_of(offered(shell, "carom " + command + " -")), options_of(command)) << command;
}

TEST(Completion, OfZshIsValid) {
  const Shell shell;
  if (shell("command -v zsh").status != 0) GTEST_SKIP() << "no zsh";
  const Outcome o = shell("zsh -n " + completion + "_carom");
  EXPECT_EQ(o.status, 0);
  EXPECT_EQ(o.err, "");
}

}  // namespace
}  // namespace carom
