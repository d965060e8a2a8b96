// Texts that are too deep or too long are refused before anything follows their levels.
#include "files/toml/nesting.hpp"

#include <sys/stat.h>

#include <fstream>
#include <string>

#include "scratch_folder.hpp"
#include "system_text.hpp"

namespace carom::tests {
namespace {

using files::most_values;

std::string repeated(const std::string& text, std::size_t times) {
  std::string all;
  for (std::size_t i = 0; i < times; ++i) all += text;
  return all;
}

InputError fault_of_file(const std::string& name) {
  try {
    load_system(name);
  } catch (const InputError& error) {
    return error;
  }
  return InputError("no fault");
}

// 20 000 levels took all of the stack: a fall by SIGSEGV with 40 kB.
TEST(Nesting, DottedKeysHaveALimit) {
  const InputError error = fault(square("[run]\na" + repeated(".a", 20000) + " = 1\n"));
  EXPECT_EQ(error.problem(), "nested too deeply");
  EXPECT_EQ(error.place().file, "test.toml");
  EXPECT_EQ(error.place().line, 6);
  EXPECT_EQ(error.place().column, 128);  // the 64th dot, one level is of the header
}

TEST(Nesting, HeadersHaveALimit) {
  for (const std::string& text :
       {"[a" + repeated(".a", 20000) + "]\n", "[[ a" + repeated(" . \"a\"", 20000) + "]]\n"}) {
    const InputError error = fault(square(text));
    EXPECT_EQ(error.problem(), "nested too deeply");
    EXPECT_EQ(error.place().line, 5);
  }
}

TEST(Nesting, ListsAndTablesCountWithTheirKeys) {
  for (const std::string& text : {repeated("[", 100), repeated("{a = ", 100),
                                  repeated("{a.a.a.a = [", 20), repeated("[\n", 100)})
    EXPECT_EQ(fault(square("[run]\nx = " + text)).problem(), "nested too deeply") << text;
}

TEST(Nesting, TextsCommentsAndNumbersAreNoLevels) {
  const std::string dots = repeated(".", 1000) + repeated("[", 1000);
  for (const std::string& title :
       {"\"\\\"" + dots + "\"", "'\"" + dots + "'", "\"\"\"\n\"\"" + dots + "\\\"\"\"\"\"\"",
        "'''\n" + dots + "''''"})
    EXPECT_EQ(fault("title = " + title + " # " + dots + "\n" + square()).problem(), "no fault")
        << title;
  EXPECT_EQ(fault(square("[run]\nt_max = 1.5\ntimes = [" + repeated("0.5,\n", 200) + "1]\n"))
                .problem()
                .find("nested"),
            std::string::npos);
  // A bare word of the command line is a text.
  EXPECT_EQ(fault(square(), set("title", "Wigner" + repeated(".", 200))).problem(), "no fault");
}

TEST(Nesting, PathsOfTheCommandLineHaveALimit) {
  for (const std::string& path :
       {"a" + repeated(".a", 30000), "table.hole" + repeated("[0]", 30000)}) {
    const InputError error = fault(square(), set(path, "1"));
    EXPECT_EQ(error.place().file, "command line");
    EXPECT_LT(std::string(error.what()).size(), 200u);
  }
  EXPECT_EQ(fault(square(), set("run.times", repeated("[", 100))).problem(), "nested too deeply");
}

TEST(Nesting, ValuesHaveALimit) {
  const InputError error = fault(square("[run]\ntimes = [" + repeated("0,", most_values) + "1]\n"));
  EXPECT_EQ(error.problem(), "too many values");
  EXPECT_EQ(error.place().line, 6);
}

// What has no end, or no writer, is neither read for ever nor kept in memory.
TEST(TextFile, DevicesPipesAndFoldersAreRefused) {
  const ScratchFolder folder;
  EXPECT_EQ(fault_of_file("/dev/zero").problem(), "is longer than 128 MB");
  EXPECT_EQ(fault(std::string((std::size_t{128} << 20) + 1, '\n')).problem(),
            "is longer than 128 MB");
  EXPECT_EQ(fault_of_file("/dev").problem(), "is a folder");
  const std::string pipe = folder.file("pipe.toml");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_NE(fault_of_file(pipe).problem(), "no fault");
  const auto with_path = [&](const std::string& path) {
    const std::string name = folder.file("a.toml");
    std::ofstream(name) << "[table]\nshape = \"discs\"\nradius = 1\npath = \"" << path << "\"\n";
    return fault_of_file(name);
  };
  EXPECT_NE(with_path("/dev/zero").problem().find("longer than 256 MB"), std::string::npos);
  EXPECT_EQ(with_path("/dev/zero").place().key, "table.path");
  EXPECT_NE(with_path("pipe.toml").problem().find("holds no disc"), std::string::npos);
  EXPECT_NE(with_path("/dev").problem().find("is a folder"), std::string::npos);
  std::ofstream(folder.file("line")) << std::string(100000, ' ');
  EXPECT_EQ(with_path("line").problem(), "a line of 100000 characters");
}

}  // namespace
}  // namespace carom::tests
