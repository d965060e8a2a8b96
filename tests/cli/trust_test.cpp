// carom run says how far its orbit can be trusted.
#include <gtest/gtest.h>

#include <cstdlib>

#include "cli/program.hpp"

namespace carom {
namespace {

TEST(Trust, WarnsOfTheOrbitThatDoublePrecisionGetsWrong) {
  // The photon among mirrors: distance 0.995262919… in truth, another in double precision.
  const Shell shell;
  const Outcome json = shell("$carom run siam-photon --json -o photon.h5");
  EXPECT_EQ(json.status, 0) << json.err;
  const double hits = std::strtod(json_value(json.out, "trusted_collisions").c_str(), nullptr);
  EXPECT_GT(hits, 5.0);
  EXPECT_LT(hits, 14.0);
  EXPECT_LT(std::strtod(json_value(json.out, "trusted_time").c_str(), nullptr), 10.0);
  EXPECT_NE(shell("$carom run siam-photon").out.find("then errors exceed"), std::string::npos);
  EXPECT_NE(shell("$carom run siam-photon --t-max 1").out.find("to the end"), std::string::npos);
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
