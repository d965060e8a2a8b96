// Periodic orbits of the magnetic square against the closed collision map.
#include <gtest/gtest.h>

#include <cmath>

#include "carom/analyses/orbits.hpp"
#include "carom/table/make.hpp"
#include "maps/closed/maps.hpp"

namespace carom {
namespace {

TEST(PeriodicOrbits, CloseUnderTheMapOfTheMagneticRectangle) {
  System system;
  system.table = rectangle(1.0, 1.0).table;
  system.particles.resize(1);
  for (const double omega : {1.0 / 0.5075, -1.3, 0.4}) {
    system.particles.front().omega = omega;
    const OrbitSearchResult found =
        find_orbits(system, {.most_hits = 5, .starts = 1000, .tries = 60});
    EXPECT_GE(found.orbits.size(), 2U);
    const maps::MagneticRectangle<double> map(1.0, 1.0, 1.0, omega);
    for (const PeriodicOrbit& orbit : found.orbits) {
      const double error = 1e3 * orbit.position_error * std::max(1.0, std::abs(orbit.trace));
      maps::Gyration<double> particle;
      const OrbitHit& start = orbit.hits.front();
      particle.x = start.position.x;
      particle.y = start.position.y;
      particle.angle = std::atan2(start.velocity.y, start.velocity.x);
      particle.side = static_cast<maps::Side>(start.wall);
      for (std::size_t i = 1; i <= orbit.hits.size(); ++i) {
        const auto next = map.next(particle);
        ASSERT_TRUE(next);
        const OrbitHit& hit = orbit.hits[i % orbit.hits.size()];
        EXPECT_EQ(static_cast<int>(next->side), hit.wall);
        EXPECT_NEAR(next->x, hit.position.x, error);
        EXPECT_NEAR(next->y, hit.position.y, error);
        particle = *next;
      }
      EXPECT_NEAR(particle.time, orbit.period, error);
    }
  }
}

}  // namespace
}  // namespace carom
