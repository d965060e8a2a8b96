// What reports say of lanes.
#include <gtest/gtest.h>

#include <string>

#include "cli/program.hpp"

namespace carom {
namespace {

// Text and JSON give the same reason, without --isa.
TEST(LanesReport, SaysWhyNothingFliesInThem) {
  const Shell shell;
  shell(
      "printf '[table]\\nshape = \"regular\"\\nsides = 65\\nradius = 1\\n[particles]\\nspeed = "
      "1\\n[run]\\nt_max = 1\\ntrajectories = 20\\n' > regular.toml");
  for (const std::string command :
       {"escape lorentz-random --t-max 1 --trajectories 20", "escape ./regular.toml",
        "escape sinai --set field.larmor_radius=2 --t-max 1 --trajectories 20",
        "diffusion lorentz-square --set field.larmor_radius=20 --t-max 1 --trajectories 20",
        "escape wigner --t-max 0.1 --trajectories 20",
        "diffusion soft-lorentz --set integrator.scheme=arkode --set integrator.tolerance=1e-6 "
        "--t-max 0.1 --trajectories 20"}) {
    const Outcome text = shell("$carom " + command + " --verbose");
    ASSERT_EQ(text.status, 0) << text.err;
    const std::string why = json_value(shell("$carom " + command + " --json").out, "no_lanes");
    ASSERT_GT(why.size(), 2u) << command;
    EXPECT_NE(text.out.find("\nlanes: none: " + why.substr(1, why.size() - 2)), std::string::npos)
        << text.out;
  }
}

TEST(LanesReport, NamesTheInstructionSet) {
  const Shell shell;
  for (const char* command :
       {"escape mushroom", "diffusion lorentz-triangular", "diffusion soft-lorentz"}) {
    const std::string run =
        std::string("$carom ") + command + " --t-max 1 --trajectories 200 --isa baseline";
    const Outcome text = shell(run + " --verbose");
    EXPECT_NE(text.out.find("\nlanes: baseline"), std::string::npos) << text.out;
    EXPECT_EQ(text.err, "");
    EXPECT_EQ(json_value(shell(run + " --json").out, "no_lanes"), "");
  }
}

}  // namespace
}  // namespace carom
