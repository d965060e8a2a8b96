// A hundred thousand hits: tens of thousands of digits in minutes (CAROM_SOAK).
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <ctime>

#include "certify/number/enclosure_of.hpp"
#include "certify/systems.hpp"
#include "soak.hpp"

namespace carom {
namespace {

using certify::ball_of;
using tests::exactly;
using tests::Shaped;

void follow(const Shaped& table, const char* slope) {
  if (!tests::soak()) GTEST_SKIP() << "CAROM_SOAK is not set";
  const ExactSystem system = tests::system_of(table, {exactly("1"), exactly(slope)});
  CertifiedTask task;
  task.collisions = 100'000;
  const std::clock_t before = std::clock();
  CertifiedOrbit orbit(system, task);
  const CertifiedEnd& end = orbit.finish();
  const double seconds = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  EXPECT_EQ(end.fate, CertifiedFate::completed);
  EXPECT_EQ(end.collisions, 100'000u);
  for (const CertifiedNumber* x : {&end.t, &end.x, &end.y, &end.vx, &end.vy})
    EXPECT_LT(x->log2_error(), -66.4);
  // It has its speed, in balls.
  const certify::Precision precision(200);
  const certify::Ball speed2 = square(ball_of(end.vx)) + square(ball_of(end.vy));
  EXPECT_TRUE(speed2.contains(certify::Ball(1)));
  std::printf("%.1f s, %ld bits, %.0f lost, %d attempts, %ld MB\n", seconds, orbit.effort().bits,
              orbit.effort().tangent_bits, orbit.effort().attempts, usage.ru_maxrss / 1024);
  EXPECT_LT(usage.ru_maxrss, 100 * 1024);
}

// 36 s an attempt measured.
TEST(LongOrbits, AHundredThousandHitsInTheStadium) {
  follow(tests::shaped("stadium", {{"half_length", "1"}, {"radius", "1"}}, "1/10", "11/50"),
         "7/10");
}

TEST(LongOrbits, AHundredThousandHitsAroundADisc) {
  Shaped walled = tests::shaped("sinai", {{"side", "1"}, {"radius", "0.4"}}, "0.05", "0.07");
  walled.spec.torus = false;
  follow(walled, "7/10");
}

// 162 s measured: 247 000 bits.
TEST(LongOrbits, AHundredThousandHitsOnTheTorus) {
  follow(tests::shaped("sinai", {{"side", "1"}, {"radius", "0.4"}}, "0.05", "0.07"), "7/10");
}

}  // namespace
}  // namespace carom
