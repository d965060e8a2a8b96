// What reports say of lanes.
#include <gtest/gtest.h>

#include <string>

#include "cli/program.hpp"

namespace carom {
namespace {

// The text is read by people, the key by programs: both say it without --isa.
TEST(LanesReport, SaysWhyNothingFliesInThem) {
  const Shell shell;
  shell(
      "printf '[table]\\nshape = \"regular\"\\nsides = 65\\nradius = 1\\n[particles]\\nspeed = "
      "1\\n[run]\\nt_max = 1\\ntrajectories = 20\\n' > regular.toml");
  const struct {
    const char *command, *why;
  } cases[] = {
      {"escape lorentz-random --t-max 1 --trajectories 20",
       "more than 64 walls, the parts between holes counted"},
      {"escape ./regular.toml", "more than 64 walls"},
      {"escape sinai --set field.larmor_radius=2 --t-max 1 --trajectories 20",
       "walls of the lattice"},
      {"diffusion lorentz-square --set field.larmor_radius=20 --t-max 1 --trajectories 20",
       "walls of the lattice"},
      {"escape wigner --t-max 0.1 --trajectories 20", "particles interact"},
      {"diffusion soft-lorentz --set integrator.scheme=arkode --set integrator.tolerance=1e-6 "
       "--t-max 0.1 --trajectories 20",
       "a scheme without a fixed step"},
  };
  for (const auto& [command, why] : cases) {
    const Outcome text = shell(std::string("$carom ") + command);
    ASSERT_EQ(text.status, 0) << text.err;
    EXPECT_NE(text.out.find("\nlanes: none: "), std::string::npos) << text.out;
    EXPECT_NE(text.out.find(why), std::string::npos) << text.out;
    EXPECT_NE(
        json_value(shell(std::string("$carom ") + command + " --json").out, "no_lanes").find(why),
        std::string::npos)
        << command;
  }
}

TEST(LanesReport, NamesTheInstructionSet) {
  const Shell shell;
  for (const char* command :
       {"escape mushroom", "diffusion lorentz-triangular", "diffusion soft-lorentz"}) {
    const std::string run =
        std::string("$carom ") + command + " --t-max 1 --trajectories 200 --isa baseline";
    const Outcome text = shell(run);
    EXPECT_NE(text.out.find("\nlanes: baseline"), std::string::npos) << text.out;
    EXPECT_EQ(text.err, "");
    EXPECT_EQ(json_value(shell(run + " --json").out, "no_lanes"), "");
  }
}

}  // namespace
}  // namespace carom
