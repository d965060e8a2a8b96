// [integrator]: defaults that are written down.
#include "carom/integrators/scheme.hpp"
#include "system_text.hpp"

namespace carom::tests {
namespace {

const std::string start =
    "initial = {kind = \"point\", position = [0.5, 0.5], velocity = [1, 0]}\n";
const std::string well = start + "[[potential]]\nkind = \"harmonic\"\n";

std::string resolved(const std::string& text) {
  return read_system(text, "test.toml").resolved_toml;
}

TEST(Integrator, DefaultsAreWrittenDown) {
  const std::string text = well + "[integrator]\nstep = 0.01\n";
  EXPECT_EQ(read(text).dynamics.integrator.scheme, default_scheme().name);
  EXPECT_EQ(read(text).dynamics.integrator.step, 0.01);
  EXPECT_NE(resolved(text).find("scheme = \"" + std::string(default_scheme().name) + "\""),
            std::string::npos);
  EXPECT_EQ(resolved(text).find("\ntolerance"), std::string::npos);
  const std::string adaptive = well + "[integrator]\nscheme = \"arkode\"\n";
  EXPECT_EQ(read(adaptive).dynamics.integrator.tolerance, default_tolerance);
  EXPECT_NE(resolved(adaptive).find("tolerance = 1e-12"), std::string::npos);
  EXPECT_EQ(resolved(resolved(adaptive)), resolved(adaptive));
}

TEST(Integrator, TolerancesAndCountsAreRead) {
  const auto plan = [](const std::string& more) {
    return read(well + "[integrator]\nstep = 0.01\n" + more).dynamics.integrator;
  };
  EXPECT_EQ(plan("").energy_tolerance, 1e-3);
  EXPECT_FALSE(plan("").count_unresolved);
  EXPECT_EQ(plan("energy_tolerance = 1e-6\n").energy_tolerance, 1e-6);
  EXPECT_TRUE(plan("unresolved = \"count\"\n").count_unresolved);
  EXPECT_NE(resolved(well + "[integrator]\nstep = 0.01\n").find("unresolved = \"stop\""),
            std::string::npos);
}

TEST(Integrator, NoForceNeedsNoStep) {
  EXPECT_EQ(read(square()).dynamics.integrator.step, 0.0);
  EXPECT_EQ(read(square("[integrator]\nscheme = \"kahan-li-8\"\n")).dynamics.integrator.scheme,
            "kahan-li-8");
}

TEST(Integrator, StepsAreCountedInDoubles) {
  const std::string text = well + "[integrator]\nstep = 1e-6\n";
  EXPECT_EQ(fault(text + "[run]\nt_max = 1e10\n").place().key, "run.t_max");
  EXPECT_EQ(read(text + "[run]\nt_max = 1e9\n").run.t_max, 1e9);
}

TEST(Integrator, StepsThatTurnTooFarAreRefusedAtWalls) {
  const std::string rest =
      "[[potential]]\nkind = \"harmonic\"\n[field]\nB = 30\n[integrator]\nstep = 0.05\n";
  EXPECT_EQ(fault(start + square(rest)).place().key, "integrator.step");
  EXPECT_EQ(fault(start + rest).problem(), "no fault");
}

}  // namespace
}  // namespace carom::tests
