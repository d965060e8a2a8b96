// FLINT costs half of a start, so the program opens it when certified numbers are asked for.
#include <gtest/gtest.h>

#include <string>

#include "cli/program.hpp"

namespace carom {
namespace {

#ifdef CAROM_LATE_FLINT
// What the loader says of a program that is run.
std::string loaded_by(const Shell& shell, const std::string& arguments) {
  const Outcome outcome = shell("LD_DEBUG=files $carom " + arguments);
  EXPECT_EQ(outcome.status, 0);
  EXPECT_NE(outcome.err.find("libc.so"), std::string::npos) << "the loader says nothing";
  return outcome.err;
}
constexpr auto nowhere = std::string::npos;

TEST(LateFlint, IsOpenedByCertifiedRunsAlone) {
  const Shell shell;
  for (const char* without : {"--version", "escape stadium --trajectories 100"})
    EXPECT_EQ(loaded_by(shell, without).find("flint"), nowhere) << without;
  for (const char* with :
       {"run circle --precision certified", "run circle", "orbit stadium --hits 2 --certify"})
    EXPECT_NE(loaded_by(shell, with).find(CAROM_LATE_FLINT), nowhere) << with;
}

// A file of its name that is no library is found first.
TEST(LateFlint, IsMissedByName) {
  const Shell shell;
  const std::string without = ": > " CAROM_LATE_FLINT "; LD_LIBRARY_PATH=. $carom ";
  for (const char* command :
       {"run circle --precision certified", "run circle", "orbit stadium --hits 2 --certify"}) {
    const Outcome outcome = shell(without + command);
    EXPECT_EQ(outcome.status, 1) << command;
    EXPECT_EQ(outcome.out, "") << command;
    EXPECT_NE(outcome.err.find("need FLINT (./" CAROM_LATE_FLINT), nowhere) << outcome.err;
  }
  EXPECT_EQ(shell(without + "escape stadium --trajectories 100").status, 0);
}
#endif

}  // namespace
}  // namespace carom
