// carom run says how far its orbit can be trusted.
#include <gtest/gtest.h>

#include <cstdlib>

#include "cli/program.hpp"

namespace carom {
namespace {

TEST(Trust, KnowsHowManyDigitsOfAnOrbitAreRight) {
  // The photon among mirrors: in double precision its last velocity is off by 8e-5, the last but
  // one hit's by less than 1e-5.
  const Shell shell;
  const Outcome json = shell("$carom run siam-photon --trust-tolerance 1e-5 --json -o photon.h5");
  EXPECT_EQ(json.status, 0) << json.err;
  const double hits = std::strtod(json_value(json.out, "trusted_collisions").c_str(), nullptr);
  EXPECT_GT(hits, 9.0);
  EXPECT_LT(hits, 14.0);
  EXPECT_LT(std::strtod(json_value(json.out, "trusted_time").c_str(), nullptr), 10.0);
}

TEST(Trust, IsNullWhereMotionIsIntegrated) {
  const Shell shell;
  for (const char* run :
       {"henon-heiles --t-max 1", "stadium --t-max 1 --engine steps --set integrator.step=0.01"}) {
    const Outcome json = shell(std::string("$carom run --json ") + run);
    EXPECT_EQ(json.status, 0) << json.err;
    EXPECT_EQ(json_value(json.out, "trusted_collisions"), "null");
    EXPECT_EQ(json_value(json.out, "trusted_time"), "null");
  }
}

// A particle that is alone flies freely, whatever interaction there would be.
TEST(Trust, OneParticleIsTrustedAsWithoutInteraction) {
  const Shell shell;
  const std::string plain = shell("$carom run siam-photon --json").out;
  const Outcome alone =
      shell("$carom run siam-photon --json --set 'interaction={kind=\"coulomb\"}'");
  EXPECT_EQ(alone.status, 0) << alone.err;
  for (const char* key : {"collisions", "trusted_collisions", "trusted_time", "x"})
    EXPECT_EQ(json_value(alone.out, key), json_value(plain, key)) << key;
}

TEST(Trust, EndsSoonerForLess) {
  const Shell shell;
  double before = 1e9;
  for (const char* tolerance : {"0.1", "1e-3", "1e-6", "1e-12"}) {
    const Outcome json =
        shell(std::string("$carom run stadium --set 'table.hole=[]' --json --trust-tolerance ") +
              tolerance);
    EXPECT_EQ(json.status, 0) << json.err;
    EXPECT_EQ(std::strtod(json_value(json.out, "trust_tolerance").c_str(), nullptr),
              std::strtod(tolerance, nullptr));
    const double hits = std::strtod(json_value(json.out, "trusted_collisions").c_str(), nullptr);
    EXPECT_LT(hits, before);
    before = hits;
  }
  for (const char* bad : {"0", "-1", "1", "nan", "x"}) {
    const Outcome refused = shell(std::string("$carom run stadium --trust-tolerance ") + bad);
    expect_refused(refused, "command line: --trust-tolerance: ");
  }
}

// The start "1/3" is not its double: the error of the start alone ends a tolerance of its size.
TEST(Trust, KnowsWhatWasWritten) {
  const Shell shell;
  shell(
      "printf '[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n[particles]\nspeed = 1\n' > "
      "square.toml");
  const std::string start =
      "$carom run ./square.toml --json --collisions 1 --trust-tolerance 1e-18 --velocity 1,0 ";
  EXPECT_EQ(json_value(shell(start + "--position 1/4,1/2").out, "trusted_collisions"), "1");
  EXPECT_EQ(json_value(shell(start + "--position 1/4,1/3").out, "trusted_collisions"), "0");
}

TEST(Trust, GoesOnWithAStoredRun) {
  const Shell shell;
  shell("$carom run sinai --t-max 40 -o whole.h5; $carom run sinai --t-max 4 -o part.h5");
  const std::string whole = shell("$carom run sinai --t-max 40 --json").out;
  const Outcome part = shell("$carom run --resume part.h5 --t-max 40 --json");
  EXPECT_EQ(part.status, 0) << part.err;
  for (const char* key : {"trusted_collisions", "trusted_time"}) {
    EXPECT_EQ(json_value(part.out, key), json_value(whole, key));
    EXPECT_NE(json_value(whole, key), "null");
  }
}

}  // namespace
}  // namespace carom
