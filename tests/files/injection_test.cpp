// [[injection]]: what is read.
#include "system_text.hpp"

namespace carom::tests {
namespace {

const std::string hole =
    "[[table.hole]]\nname = \"door\"\nwall = \"top\"\ncenter = 0.5\nwidth = 0.1\n";

std::string injection(const std::string& keys, const std::string& more = "") {
  return square(hole + "[[injection]]\n" + keys + more + "\n[run]\nt_max = 10\n");
}

TEST(Injection, IsRead) {
  const System system = read(injection(
      "hole = \"door\"\ntimes = [0, \"1/3\", 10]\n[[injection]]\nhole = \"door\"\nrate = 2\n"
      "speed = 3\n",
      "[particles]\nmass = 2\ncharge = -1\nspeed = 5\n[field]\nB = 4\n"));
  ASSERT_EQ(system.injections.size(), 2u);
  EXPECT_EQ(system.injections[0].times, (std::vector<double>{0.0, 1.0 / 3.0, 10.0}));
  EXPECT_EQ(system.injections[0].particle.speed, 5.0);
  EXPECT_EQ(system.injections[1].rate, 2.0);
  EXPECT_EQ(system.injections[1].particle.speed, 3.0);
  EXPECT_EQ(system.injections[1].particle.omega, -2.0);
  EXPECT_TRUE(read(square()).injections.empty());
}

TEST(Injection, ResolvedTextIsReadAgain) {
  const std::string text = injection("hole = \"door\"\nrate = 0.5\n");
  const LoadedSystem first = read_system(text, "test.toml");
  const LoadedSystem second = read_system(first.resolved_toml, "test.toml");
  EXPECT_EQ(second.resolved_toml, first.resolved_toml);
  ASSERT_EQ(second.system.injections.size(), 1u);
  EXPECT_EQ(second.system.injections[0].rate, 0.5);
}

}  // namespace
}  // namespace carom::tests
