// Bad system files: every command names the place, ends with status 1 and writes nothing.
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "program.hpp"

namespace carom {
namespace {

TEST(BadFiles, AreRefusedByEveryCommand) {
  const Shell shell;
  const std::string square = "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n";
  const std::pair<std::string, const char*> files[] = {
      {square + "colour = 3\n", "a.toml, line 5, column 1: table.colour: "},
      {"[table]\nshape = \"circle\nradius = 1\n", "a.toml, line 2, "},
      {square + "[initial]\nkind = \"point\"\nposition = [2, 0.5]\nvelocity = [1, 0]\n",
       "a.toml, line 7, column 12: initial.position: "}};
  for (const auto& [text, place] : files) {
    shell("cat > a.toml << 'END'\n" + text + "END");
    for (const char* command : {"escape a.toml -o a.h5", "run a.toml -o a.h5"}) {
      expect_refused(shell(std::string("$carom ") + command), place);
      EXPECT_EQ(shell.files(), std::vector<std::string>{"a.toml"}) << "something was written";
    }
  }
  for (const char* command : {"escape", "run", "table"})
    expect_refused(shell("$carom " + std::string(command) + " ./missing.toml"), "./missing.toml: ");
}

}  // namespace
}  // namespace carom
