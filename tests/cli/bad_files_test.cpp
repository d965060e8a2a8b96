// System files that are none: one clear line on standard error, status 1, nothing written.
#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <vector>

#include "program.hpp"

namespace carom {
namespace {

struct BadFile {
  const char* name;  ///< of the test
  std::string text;
  const char* message;
};

void PrintTo(const BadFile& bad, std::ostream* out) { *out << bad.text; }

const std::string square = "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n";
const std::string hole = "[[table.hole]]\nwall = \"top\"\ncenter = 0.5\nwidth = 0.4\n";

std::string polygon(const std::string& points) {
  return "[table]\nshape = \"polygon\"\npoints = " + points + "\n";
}

const std::vector<BadFile>& bad_files() {
  static const std::vector<BadFile> all = {
      {"UnknownKey", square + "colour = 3\n",
       "a.toml, line 5, column 1: table.colour: unknown key 'colour' for 'rectangle'"},
      {"MisspeltKey", "[table]\nshape = \"circle\"\nradus = 1\n", "did you mean 'radius'?"},
      {"WrongType", "[table]\nshape = \"circle\"\nradius = true\n",
       "a.toml, line 3, column 10: table.radius: must be a number"},
      {"TomlSyntax", "[table]\nshape = \"circle\nradius = 1\n", "a.toml, line 2"},
      {"ZeroSize", "[table]\nshape = \"circle\"\nradius = 0\n",
       "a.toml, line 3, column 10: table.radius: must be positive, not 0"},
      {"NegativeSize", "[table]\nshape = \"circle\"\nradius = -1\n", "must be positive, not -1"},
      {"NanSize", "[table]\nshape = \"circle\"\nradius = nan\n", "'nan' is not a finite number"},
      {"InfiniteSize", "[table]\nshape = \"circle\"\nradius = inf\n",
       "'inf' is not a finite number"},
      {"InfiniteField", square + "[field]\nB = inf\n", "field.B: 'inf' is not a finite number"},
      {"HoleWiderThanItsWall",
       square + "[[table.hole]]\nwall = \"top\"\ncenter = 0.5\nwidth = 1.5\n",
       "a.toml, line 8, column 9: table.hole[0].width: the hole is wider than its wall"},
      {"HoleOverAnother", square + hole + hole, "the hole 'hole_2' overlaps 'hole_1'"},
      {"UnknownWall", square + "[[table.hole]]\nwall = \"botom\"\ncenter = 0.5\nwidth = 0.1\n",
       "unknown wall 'botom'"},
      {"SelfCrossingPolygon", polygon("[[0, 0], [2, 0], [0, 1], [2, 1]]"), "cross near (1, 0.5)"},
      {"OpenPath",
       "[table]\nshape = \"path\"\n[[table.loop]]\nstart = [0, 0]\n"
       "pieces = [{line_to = [1, 0]}, {line_to = [0, 1]}]\n",
       "the path is open"},
      {"StartOutside",
       square + "[initial]\nkind = \"point\"\nposition = [2, 0.5]\nvelocity = [1, 0]\n",
       "a.toml, line 7, column 12: initial.position"},
      {"ZeroSpeed", square + "[particles]\nspeed = 0\n",
       "particles.speed: must be positive, not 0"},
      {"ZeroVelocity",
       square + "[initial]\nkind = \"point\"\nposition = [0.5, 0.5]\nvelocity = [0, 0]\n",
       "the velocity is zero"},
      {"ZeroTime", square + "[run]\nt_max = 0\n", "run.t_max: must be positive, not 0"},
      {"NegativeTime", square + "[run]\nt_max = -1\n", "run.t_max: must be positive, not -1"},
      {"NoTrajectories", square + "[run]\ntrajectories = 0\n", "a whole number from 1"},
      {"NegativeTrajectories", square + "[run]\ntrajectories = -5\n", ", not -5"},
      {"TrajectoriesInWords", square + "[run]\ntrajectories = \"many\"\n", ", not many"}};
  return all;
}

class BadFiles : public testing::TestWithParam<BadFile> {};

TEST_P(BadFiles, AreRefusedByEveryCommand) {
  const Shell shell;
  shell("cat > a.toml << 'END'\n" + GetParam().text + "END");
  for (const char* command : {"escape a.toml -o a.h5", "run a.toml -o a.h5"}) {
    const Outcome o = shell(std::string("$carom ") + command);
    EXPECT_EQ(o.status, 1) << command;
    EXPECT_EQ(o.out, "");
    EXPECT_EQ(o.err.rfind("carom: ", 0), 0u) << o.err;
    EXPECT_NE(o.err.find(GetParam().message), std::string::npos) << o.err;
    EXPECT_EQ(shell.files(), std::vector<std::string>{"a.toml"}) << "something was written";
  }
}

INSTANTIATE_TEST_SUITE_P(All, BadFiles, testing::ValuesIn(bad_files()),
                         [](const auto& one) { return std::string(one.param.name); });

TEST(BadFiles, ThatAreNotThere) {
  const Shell shell;
  for (const char* command : {"escape", "run", "table"}) {
    const Outcome o = shell("$carom " + std::string(command) + " ./missing.toml");
    EXPECT_EQ(o.status, 1) << command;
    EXPECT_EQ(o.out, "");
    EXPECT_NE(o.err.find("./missing.toml: cannot be read: No such file"), std::string::npos)
        << o.err;
  }
}

}  // namespace
}  // namespace carom
