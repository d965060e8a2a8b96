// [[injection]]: what is read and what is refused.
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

TEST(Injection, FaultsAreNamed) {
  const std::pair<const char*, const char*> faults[] = {
      {"hole = \"dor\"\nrate = 1\n",
       "unknown hole 'dor' (expected one of door; did you mean 'door'?)"},
      {"rate = 1\n", "injection[0].hole: the key 'hole' is missing"},
      {"hole = \"door\"\n", "neither times nor rate"},
      {"hole = \"door\"\nrate = 1\ntimes = [1]\n", "rate"},
      {"hole = \"door\"\nrate = -1\n", "injection[0].rate: must be positive, not -1"},
      {"hole = \"door\"\nrate = 0\n", "must be positive"},
      {"hole = \"door\"\nrate = 1\nspeed = 0\n", "injection[0].speed: must be positive"},
      {"hole = \"door\"\ntimes = []\n", "the list is empty"},
      {"hole = \"door\"\ntimes = [-1]\n", "must not be negative"},
      {"hole = \"door\"\ntimes = [1, 3, 3]\n",
       "injection[0].times[2]: the times do not increase at 3"},
      {"hole = \"door\"\ntimes = [1, 11]\n", "the time 11 comes after t_max = 10"},
      {"hole = \"door\"\nrate = 100001\n", "too many particles enter"},
      {"hole = \"door\"\nrat = 1\n", "did you mean 'rate'?"},
  };
  for (const auto& [keys, message] : faults)
    EXPECT_HAS(fault(injection(keys)), message) << "\nof\n" << keys;
  EXPECT_HAS(fault(square(hole + "[injection]\nhole = \"door\"\nrate = 1\n")),
             "[[injection]], with two brackets");
  EXPECT_HAS(fault(square("[[injection]]\nhole = \"door\"\nrate = 1\n")),
             "a table with [[table.hole]]");
  EXPECT_HAS(fault(injection("hole = \"door\"\nrate = 1\n",
                             "[[potential]]\nkind = \"harmonic\"\n[integrator]\nstep = 0.01\n")),
             "particles cannot be injected in a system with forces");
  EXPECT_HAS(fault(injection(
                 "hole = \"door\"\nrate = 1\n",
                 "[particles]\ncount = 1\n[interaction]\nkind = \"hard-discs\"\nradius = 0.01\n")),
             "particles cannot be injected in a system of hard discs");
}

}  // namespace
}  // namespace carom::tests
