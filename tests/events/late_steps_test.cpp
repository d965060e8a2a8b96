// Steps are counted in doubles: what is so late that they cannot be counted ends by a reason, and
// never hangs.
#include <gtest/gtest.h>

#include <cmath>

#include "carom/events/world.hpp"
#include "carom/files/system_file.hpp"
#include "events/step/group.hpp"

namespace carom {

using namespace events;

namespace {

TEST(LateSteps, TheNextMultipleIsFoundOrInfinite) {
  const double step = 1e-6;
  for (const double k : {0.0, 1.0, 3e9, 0x1p40 + 1.0, 0x1p52 - 2.0}) {
    EXPECT_EQ(next_multiple(multiple(k, step), step), multiple(k + 1.0, step)) << k;
    EXPECT_EQ(next_multiple(multiple(k + 0.5, step), step), multiple(k + 1.0, step)) << k;
  }
  for (const double now : {0x1p52 * step, 1e10, 1e300})
    EXPECT_TRUE(std::isinf(next_multiple(Time(now), step).value())) << now;
  EXPECT_TRUE(std::isinf(next_multiple(Time(1e300), 1e-300).value()));
}

TEST(LateSteps, AParticleThatIsIntegratedThereIsLostWithTheReason) {
  const System system = read_system(
                            "[table]\nshape = \"circle\"\nradius = 1\n[[potential]]\nkind = "
                            "\"harmonic\"\n[integrator]\nstep = 1e-6\n",
                            "late")
                            .system;
  World world(*system.table, system.dynamics);
  State start;
  start.position = {0.25, 0.0};
  start.velocity = {0.0, 0.5};
  start.time = Time(1e10);
  const int particle = world.add(system.particles.front(), start);
  world.run_until(2e10);
  EXPECT_EQ(world.fate(particle), Fate::unresolved);
  EXPECT_NE(world.report(particle).find("2^52"), std::string::npos) << world.report(particle);
}

}  // namespace
}  // namespace carom
