// Titles and names that act on a terminal or break XML, and links that are planted where files are
// made.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include "program.hpp"

namespace carom {
namespace {

// Characters that act: all controls but ends of lines, and what turns the direction of writing.
bool acts(const std::string& text) {
  const auto control = [](char c) {
    return (static_cast<unsigned char>(c) < 0x20 && c != '\n') || c == 0x7f;
  };
  return std::any_of(text.begin(), text.end(), control) ||
         text.find("\u202e") != std::string::npos || text.find("\u009b") != std::string::npos;
}

const std::string title = R"(a\u001b]0;owned\u0007 \u009b31m\u202e\u007f\u0001 <b>\nlost: 0)";

void write_system(const Shell& shell) {
  std::ofstream(shell.folder() + "/a.toml")
      << "title = \"" << title << "\"\n"
      << "[table]\nshape = \"circle\"\nradius = 1\n[[table.hole]]\nwall = \"circle\"\ncenter = 0\n"
         "width = 0.5\n[run]\nt_max = 5\ntrajectories = 20\n";
}

TEST(HostileTexts, TerminalsGetNoCommands) {
  const Shell shell;
  write_system(shell);
  for (const std::string command :
       {"table a.toml", "run a.toml", "escape a.toml", "escape a.toml --sweep run.seed=list:1,2",
        "run a.toml --set 'a\x1b[31m=1'", "run a.toml --set title=$(printf 'a\\033[31m')",
        "section a.toml", "lyapunov a.toml --closed"}) {
    const Outcome o = shell("$carom " + command + " --quiet");
    EXPECT_FALSE(acts(o.out)) << command << "\n" << o.out;
    EXPECT_FALSE(acts(o.err)) << command << "\n" << o.err;
    EXPECT_EQ(o.out.find("\nlost: 0"), std::string::npos) << command;
  }
}

TEST(HostileTexts, JsonKeepsThem) {
  const Shell shell;
  write_system(shell);
  const Outcome o = shell("$carom table a.toml --json");
  EXPECT_TRUE(is_json_object(o.out)) << o.out;
  EXPECT_FALSE(acts(o.out));
  EXPECT_EQ(json_value(o.out, "title"), '"' + title + '"');
}

TEST(HostileTexts, NamesAreRefused) {
  const Shell shell;
  write_system(shell);
  const Outcome o = shell("$carom table a.toml --set 'table.hole[0].name=\"a\\u001b[2J\"'");
  expect_refused(o, "command line: table.hole[0].name");
  EXPECT_FALSE(acts(o.err));
}

// FILE.part/new and its neighbours, planted by another user of the folder.
TEST(PlantedLinks, AreNotFollowed) {
  const std::vector<std::string> writers = {
      "escape circle --closed --trajectories 20 --t-max 5 -o a.h5",
      "escape circle --closed --trajectories 20 --t-max 5 --per-trajectory -o a.h5",
      "run circle --closed --t-max 5 -o a.h5",
      "run --resume kept.h5 --t-max 5 -o a.h5",
      "section circle --closed --orbits 2 --points 3 -o a.h5",
      "orbit three-disc --hits 2 -o a.h5",
      "escape circle --closed --trajectories 20 --sweep run.t_max=list:1,2 -o a.h5"};
  const std::vector<std::string> names = {"new", "records", "sweep", "value-0", "value-0.report"};
  const Shell shell;
  ASSERT_EQ(shell("$carom run circle --closed --t-max 3 -o kept.h5 --quiet").status, 0);
  for (const std::string& writer : writers) {
    const std::string file = "a.h5";
    std::string plant = "mkdir " + file + ".part; touch " + file + ".part/carom.lock; ";
    for (const std::string& name : names)
      plant +=
          "echo precious > " + name + "; ln -s ../" + name + " " + file + ".part/" + name + "; ";
    ASSERT_EQ(shell(plant).status, 0);
    const Outcome o = shell("$carom " + writer + " --force --quiet");
    EXPECT_EQ(o.status, 0) << writer << "\n" << o.err;
    for (const std::string& name : names)
      EXPECT_EQ(shell.read(name), "precious\n") << writer << " wrote through " << name;
    shell("rm -rf a.h5 a.h5.part");
  }
}

}  // namespace
}  // namespace carom
