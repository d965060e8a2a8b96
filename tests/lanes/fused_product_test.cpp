// Lanes round a b + c once, like the C library's fma, on every instruction set.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>
#include <vector>

#include "carom/events/world.hpp"
#include "carom/lanes/free_lanes.hpp"
#include "lanes/fused_in_lanes.hpp"
#include "lanes/one_by_one.hpp"
#include "random_tables.hpp"

namespace carom {
namespace {

/// With the processor's instruction, or as if it had none.
class Processor {
 public:
  explicit Processor(bool fuses) : before_(detail::fuses) { detail::fuses = fuses; }
  ~Processor() { detail::fuses = before_; }

 private:
  bool before_;
};

std::uint64_t bits(double x) { return std::bit_cast<std::uint64_t>(x); }

void expect_fused(tests::FuseAll fuse_all, const char* what) {
  constexpr int count = 8;
  std::mt19937_64 engine(7);
  const auto number = [&](int range) {
    const auto exponent = static_cast<int>(engine() % static_cast<unsigned>(2 * range + 1)) - range;
    return std::ldexp(
        (static_cast<double>(engine() >> 11) + 0.5) * ((engine() & 1) != 0 ? 0x1p-53 : -0x1p-53),
        exponent);
  };
  for (int k = 0; k < 20'000; ++k) {
    double a[count], b[count], c[count], sums[count];
    for (int i = 0; i < count; ++i) {
      a[i] = number(i == 7 ? 1000 : 10);
      b[i] = number(i == 7 ? 1000 : 10);
      c[i] = i % 2 == 0 ? -a[i] * b[i] : number(i == 7 ? 1000 : 60);  // cancelling, or any
    }
    fuse_all(a, b, c, sums, count);
    for (int i = 0; i < count; ++i)
      ASSERT_EQ(bits(sums[i]), bits(std::fma(a[i], b[i], c[i])))
          << what << " " << a[i] << " " << b[i] << " " << c[i];
  }
}

TEST(FusedInLanes, IsTheLibrarysOnEveryInstructionSet) {
  if (!detail::fuses) GTEST_SKIP() << "this processor has no such instruction";
  expect_fused(tests::fuse_baseline, "baseline");
#if defined(CAROM_TEST_WIDE_LANES)
  if (available(InstructionSet::avx2)) expect_fused(tests::fuse_avx2, "avx2");
  if (available(InstructionSet::avx512)) expect_fused(tests::fuse_avx512, "avx512");
#endif
}

/// Where the orbits of some starts end.
std::vector<std::uint64_t> ends(const Table& table, double omega, bool in_lanes) {
  std::vector<LaneStart> starts;
  tests::Dice dice(3);
  for (int i = 0; i < 40; ++i) {
    LaneStart start;
    start.particle.omega = omega;
    start.state.position = {0.3, 0.2};
    start.state.velocity = dice.direction();
    start.particle.speed = std::sqrt(dot(start.state.velocity, start.state.velocity));
    start.tag = starts.size();
    starts.push_back(start);
  }
  std::vector<std::uint64_t> found(5 * starts.size());
  const auto keep = [&](std::size_t i, const State& s) {
    const double numbers[] = {s.position.x, s.position.y, s.velocity.x, s.velocity.y, s.time.high};
    for (std::size_t k = 0; k < 5; ++k) found[5 * i + k] = bits(numbers[k]);
  };
  if (in_lanes) {
    FreeLanes lanes(table, {starts[0].particle}, InstructionSet::baseline);
    lanes.limit_hits(100);
    lanes.run_until(1e300, tests::one_by_one(starts),
                    [&](const LaneEnd& end) { keep(end.tag, end.state); });
    return found;
  }
  World world(table);
  Observer nothing;
  for (const LaneStart& start : starts) {
    world.clear();
    world.limit_hits(100);
    world.add(start.particle, start.state);
    world.run_until(1e300, nothing);
    keep(start.tag, world.state(0));
  }
  return found;
}

TEST(FusedInLanes, AreTheSameOrbitsWithoutTheInstruction) {
  const Table ellipse = tests::loop({geometry::Ellipse{{0, 0}, {1, 0}, 0.75, true}});
  for (const Table& table : {tests::stadium(), tests::disc(1.3), tests::mushroom(1.0, 0.5, 1.0),
                             tests::with_disc(tests::square(), {0.8, 0.8}, 0.1), ellipse})
    for (const double omega : {0.0, 0.4}) {
      const auto expected = ends(table, omega, false);
      const Processor without(false);
      EXPECT_EQ(ends(table, omega, false), expected);
      EXPECT_EQ(ends(table, omega, true), expected);
    }
}

}  // namespace
}  // namespace carom
