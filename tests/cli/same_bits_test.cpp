// The same bits with and without fused multiply-add in the machine's elementary functions, on any
// number of threads, and by a program that another compiler made.
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "program.hpp"

namespace carom {
namespace {

const char* systems[] = {"magnetic-square",    "stadium",  "ellipse-magnetic", "sinai",
                         "lorentz-triangular", "mushroom", "soft-lorentz"};

std::string ensemble(const std::string& system) {
  const bool integrated = system == "soft-lorentz";
  return " escape " + system + " --trajectories 1e4 --t-max " + (integrated ? "10" : "40") +
         " --json --quiet";
}

TEST(SameBits, MachinesWithoutFusedMultiplyAddGiveTheSameBits) {
  const Shell shell;
  for (const char* system : systems) {
    const Outcome usual = shell("$carom" + ensemble(system) + " --threads 2");
    const Outcome plain =
        shell("GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-AVX2,-FMA4,-FMA_Usable,-AVX2_Usable $carom" +
              ensemble(system) + " --threads 1");
    ASSERT_EQ(usual.status, 0) << usual.err;
    ASSERT_EQ(plain.status, 0) << plain.err;
    EXPECT_EQ(json_value(usual.out, "digest"), json_value(plain.out, "digest")) << system;
    EXPECT_EQ(json_value(usual.out, "lost"), "0") << system;
  }
}

TEST(SameBits, AnotherSeedIsAnotherDigest) {
  const Shell shell;
  for (const char* system : {"stadium", "soft-lorentz"}) {
    const Outcome one = shell("$carom" + ensemble(system)),
                  two = shell("$carom" + ensemble(system) + " --seed 2");
    EXPECT_NE(json_value(one.out, "digest"), json_value(two.out, "digest")) << system;
  }
}

// CAROM_OTHER_PROGRAM: the program built by another compiler (tests/other_compiler.sh makes one).
TEST(SameBits, AnotherCompilerGivesTheSameBits) {
  const char* other = std::getenv("CAROM_OTHER_PROGRAM");
  if (!other) GTEST_SKIP() << "CAROM_OTHER_PROGRAM is not set";
  const Shell shell;
  for (const char* system : systems) {
    const Outcome usual = shell("$carom" + ensemble(system));
    const Outcome theirs = shell(std::string(other) + ensemble(system));
    ASSERT_EQ(theirs.status, 0) << theirs.err;
    EXPECT_EQ(json_value(usual.out, "digest"), json_value(theirs.out, "digest")) << system;
  }
}

}  // namespace
}  // namespace carom
