// Powers of two are no arithmetic: a system in other units must give the same bits, wherever it is
// allowed.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "carom/events/decision_range.hpp"
#include "carom/events/world.hpp"
#include "carom/files/system_file.hpp"
#include "carom/starts/sampler.hpp"
#include "recorder.hpp"

namespace carom {
namespace {

std::string scaled(double x, int exponent) {
  char text[40];
  std::snprintf(text, sizeof text, "\"%.17g\"", std::ldexp(x, exponent));
  return text;
}

/// A table of that shape in units of 2^length, flown through at 2^speed, B = b in its own units.
std::string text_of(const std::string& shape, int length, int speed, double b) {
  const auto l = [&](double x) { return scaled(x, length); };
  std::string t = "[table]\nshape = \"" + shape + "\"\n";
  if (shape == "rectangle") t += "width = " + l(1.0) + "\nheight = " + l(0.75) + "\n";
  if (shape == "stadium") t += "half_length = " + l(0.5) + "\nradius = " + l(1.0) + "\n";
  if (shape == "ellipse") t += "a = " + l(1.0) + "\nb = " + l(0.75) + "\n";
  if (shape == "annulus")
    t += "outer = " + l(1.0) + "\ninner = " + l(0.25) + "\noffset = " + l(0.375) + "\n";
  if (shape == "sinai") t += "side = " + l(1.0) + "\nradius = " + l(0.25) + "\n";
  return t + "[field]\nB = " + scaled(b, speed - length) +
         "\n[particles]\nspeed = " + scaled(1.0, speed) +
         "\n[initial]\nkind = \"uniform\"\n[run]\nt_max = " + scaled(64.0, length - speed) + "\n";
}

struct Orbits {
  std::vector<HitEvent> hits;
  DecisionCounts decisions;
};

Orbits run(const std::string& text) {
  const System system = read_system(text, "scales").system;
  World world(*system.table);
  tests::Recorder recorder;
  for (std::uint64_t k = 0; k < 4; ++k) {
    world.clear();
    world.add(system.particles[0], Sampler(system).draw(world, k, 0));
    world.run_until(system.run.t_max, recorder);
  }
  return {recorder.hits, world.decisions()};
}

bool is_refused(const std::string& text) {
  try {
    read_system(text, "scales");
  } catch (const InputError&) {
    return true;
  }
  return false;
}

TEST(Scales, PowersOfTwoChangeNoBit) {
  for (const char* shape : {"rectangle", "stadium", "ellipse", "annulus", "sinai"}) {
    for (const double b : {0.0, 0.75, 3.0}) {
      const Orbits usual = run(text_of(shape, 0, 0, b));
      ASSERT_GT(usual.hits.size(), 40u) << shape;
      int allowed = 0;
      for (const int length : {-95, 0, 95})
        for (const int speed : {-199, -150, -95, -59, 0, 50, 95, 150, 199}) {
          const std::string text = text_of(shape, length, speed, b);
          if (is_refused(text)) continue;
          ++allowed;
          const Orbits other = run(text);
          ASSERT_EQ(other.hits.size(), usual.hits.size())
              << shape << " " << b << " " << length << " " << speed;
          EXPECT_EQ(other.decisions.filter, usual.decisions.filter);
          EXPECT_EQ(other.decisions.exact, usual.decisions.exact);
          for (std::size_t i = 0; i < usual.hits.size(); ++i) {
            const HitEvent &x = usual.hits[i], &y = other.hits[i];
            ASSERT_EQ(y.wall, x.wall);
            ASSERT_EQ(y.u, x.u) << shape << " " << b << " " << length << " " << speed;
            ASSERT_EQ(std::ldexp(y.position.x, -length), x.position.x);
            ASSERT_EQ(std::ldexp(y.after.y, -speed), x.after.y);
            ASSERT_EQ(std::ldexp(y.time.high, speed - length), x.time.high);
          }
        }
      EXPECT_GE(allowed, std::string(shape) == "ellipse" && b > 0.0 ? 4 : 12) << shape << " " << b;
    }
  }
}

// In each of these hits were missed or found at wrong walls: squares that vanish or overflow, and
// bounds with them.
TEST(Scales, ScalesBeyondTheRangeAreRefused) {
  EXPECT_TRUE(is_refused(text_of("rectangle", 0, 504, 0.75)));
  for (const auto& [length, speed] : {std::pair{0, 511}, {95, -420}, {-95, 420}, {0, -480}})
    for (const double b : {0.0, 0.75})
      EXPECT_TRUE(is_refused(text_of("stadium", length, speed, b)));
  EXPECT_TRUE(is_refused(text_of("ellipse", 0, 70, 0.75)));
  EXPECT_FALSE(is_refused(text_of("ellipse", 0, 70, 0.0)));
  EXPECT_TRUE(is_refused(text_of("rectangle", 0, 0, 0x1p201)));
}

}  // namespace
}  // namespace carom
