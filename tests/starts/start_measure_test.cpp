// Starts that are stationary for the flow, and those of the map.
#include "carom/starts/start_measure.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "analyses/systems.hpp"
#include "carom/analyses/lyapunov.hpp"

namespace carom {
namespace {

System stadium(const std::string& initial, double t_max, std::uint64_t trajectories,
               const std::string& more = "") {
  return make_system("[table]\nshape = \"stadium\"\nhalf_length = 2\nradius = 1\n" + more +
                     "[initial]\n" + initial + "\n[run]\nt_max = " + std::to_string(t_max) +
                     "\ntrajectories = " + std::to_string(trajectories) + "\n");
}
const char* const uniform = "kind = \"uniform\"";
const char* const boundary = "kind = \"boundary\"";
const char* const bottom = "kind = \"boundary\"\nwall = \"bottom\"";

TEST(StartMeasure, IsStationaryWhereNothingIsLeftOut) {
  const auto why = [](const std::string& initial, const std::string& more = "") {
    return why_not_stationary(stadium(initial, 10, 10, more));
  };
  EXPECT_EQ(why(uniform), "");
  EXPECT_EQ(why("kind = \"sobol\""), "");
  EXPECT_EQ(why(uniform, "[field]\nB = 1\n"), "");
  EXPECT_EQ(why(uniform, "[particles]\ncount = 3\n"), "");
  EXPECT_NE(why(boundary), "");
  EXPECT_NE(why(bottom), "");
  EXPECT_NE(why("kind = \"point\"\nposition = [0, 0]\nangle = 1"), "");
  EXPECT_NE(why("kind = \"rectangle\"\nmin = [0, 0]\nmax = [1, 1]"), "");
  EXPECT_NE(why(uniform, "[[table.hole]]\nwall = \"top\"\ncenter = 1\nwidth = 0.1\n"), "");
  const std::string well = "[[potential]]\nkind = \"harmonic\"\nomega = 1\n";
  EXPECT_EQ(why(uniform, well + "[particles]\nenergy = 3\n"), "");
  EXPECT_NE(why(uniform, well + "[particles]\nspeed = 1\n"), "");
  const std::string law = "[[table.wall]]\nwall = \"top\"\nlaw = ";
  EXPECT_EQ(why(uniform, law + "\"diffuse\"\n"), "");
  EXPECT_NE(why(uniform, law + "\"rough\"\nangle = \"60 deg\"\n"), "");
  const std::string charges =
      "[interaction]\nkind = \"coulomb\"\nstrength = 1\n[particles]\nenergy = 3\ncount = ";
  EXPECT_EQ(why(uniform, charges + "1\n"), "");
  EXPECT_NE(why(uniform, charges + "2\n"), "");
  const std::string discs =
      "[interaction]\nkind = \"hard-discs\"\nradius = 0.1\n[particles]\nspeed = 1\ncount = ";
  EXPECT_EQ(why(uniform, discs + "1\n"), "");
  EXPECT_NE(why(uniform, discs + "2\n"), "");
}

TEST(StartMeasure, KnowsTheMeasureOfTheMap) {
  EXPECT_TRUE(starts_of_the_map(stadium(boundary, 10, 10)));
  EXPECT_TRUE(starts_of_the_map(
      make_system("[table]\nshape = \"circle\"\nradius = 1\n[initial]\nkind = \"boundary\"\nwall = "
                  "\"circle\"\n")));
  EXPECT_FALSE(starts_of_the_map(stadium(bottom, 10, 10)));
  EXPECT_FALSE(starts_of_the_map(stadium(uniform, 10, 10)));
  // The orbits that stay are the repeller's, or end.
  EXPECT_FALSE(starts_of_the_map(
      stadium(boundary, 10, 10, "[[table.hole]]\nwall = \"top\"\ncenter = 1\nwidth = 0.1\n")));
}

// Starts on all walls give the exponent of the flow. Those of the map themselves are off by four
// errors here.
TEST(StartMeasure, OfExponentsIsThatOfTheFlow) {
  const LyapunovResult drawn = run_lyapunov(stadium(boundary, 400, 20000));
  const LyapunovEstimate e = estimate_of(drawn.growth);
  EXPECT_NEAR(e.per_time.value, 0.34397, 3.0 * std::hypot(e.per_time.error, 3e-5));
  EXPECT_LT(e.per_time.error, 1e-3);
  EXPECT_EQ(drawn.digest, run_lyapunov(stadium(uniform, 400, 20000)).digest);
}

// Orbits from a wall never are circles that meet none.
TEST(StartMeasure, LeavesOutCirclesThatMeetNoWall) {
  const std::string field = "[field]\nlarmor_radius = 0.4\n";
  const LyapunovResult of_map = run_lyapunov(stadium(boundary, 50, 400, field)),
                       of_flow = run_lyapunov(stadium(uniform, 50, 400, field));
  EXPECT_GT(of_map.pinned, 20u);
  EXPECT_EQ(of_map.growth.totals().orbits + of_map.pinned, 400u);
  EXPECT_EQ(of_flow.growth.totals().orbits, 400u);
}

// From one wall the exponent drifts.
TEST(StartMeasure, OfOneWallDrifts) {
  const LyapunovResult r = run_lyapunov(stadium(bottom, 400, 20000));
  const auto drift = drift_of(r.drift, r.growth.window(), estimate_of(r.growth).per_time);
  ASSERT_TRUE(drift.has_value());
  EXPECT_TRUE(drift->seen);
  EXPECT_LT(drift->fast.value, 0.0);
}

}  // namespace
}  // namespace carom
