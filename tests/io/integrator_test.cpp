// [integrator]: defaults that are written down, faults at their places.
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
  EXPECT_HAS(resolved(text), "scheme = \"" + std::string(default_scheme().name) + "\"");
  EXPECT_EQ(resolved(text).find("\ntolerance"), std::string::npos);
  const std::string adaptive = well + "[integrator]\nscheme = \"arkode\"\n";
  EXPECT_EQ(read(adaptive).dynamics.integrator.tolerance, default_tolerance);
  EXPECT_HAS(resolved(adaptive), "tolerance = 1e-12");
  EXPECT_EQ(resolved(resolved(adaptive)), resolved(adaptive));
}

TEST(Integrator, WhatCannotBeTrusted) {
  const auto plan = [](const std::string& more) {
    return read(well + "[integrator]\nstep = 0.01\n" + more).dynamics.integrator;
  };
  EXPECT_EQ(plan("").energy_tolerance, 1e-3);
  EXPECT_FALSE(plan("").count_unresolved);
  EXPECT_EQ(plan("energy_tolerance = 1e-6\n").energy_tolerance, 1e-6);
  EXPECT_TRUE(plan("unresolved = \"count\"\n").count_unresolved);
  EXPECT_HAS(resolved(well + "[integrator]\nstep = 0.01\n"), "unresolved = \"stop\"");
  EXPECT_HAS(fault(well + "[integrator]\nstep = 0.01\nenergy_tolerance = 0\n"),
             "line 6, column 20: integrator.energy_tolerance: must be");
  EXPECT_HAS(fault(well + "[integrator]\nstep = 0.01\nunresolved = \"cuont\"\n"),
             "line 6, column 14: integrator.unresolved: unknown");
  EXPECT_HAS(fault(well + "[integrator]\nstep = 0.01\nunresolved = \"cuont\"\n"),
             "did you mean 'count'?");
}

TEST(Integrator, NoForceNeedsNoStep) {
  EXPECT_EQ(read(square()).dynamics.integrator.step, 0.0);
  EXPECT_EQ(read(square("[integrator]\nscheme = \"kahan-li-8\"\n")).dynamics.integrator.scheme,
            "kahan-li-8");
}

TEST(Integrator, FaultsAreAtTheirPlaces) {
  EXPECT_HAS(fault(well + "[integrator]\nstep = 0\n"),
             "line 5, column 8: integrator.step: must be");
  EXPECT_HAS(fault(square("[integrator]\nscheme = \"kahan-li\"\n")),
             "line 6, column 10: integrator.scheme: unknown scheme");
  EXPECT_HAS(fault(square("[integrator]\nscheme = \"kahan-li\"\n")), "did you mean 'kahan-li-6'?");
  EXPECT_HAS(fault(square("[integrator]\nscheme = \"kahan-li\"\n")),
             "mclachlan-ss17, arkode, cvode");
  EXPECT_HAS(fault(square("[integrator]\nstep = 0.1\ntolerance = 1e-9\n")),
             "line 7, column 13: integrator.tolerance: the scheme");
  EXPECT_HAS(fault(square("[integrator]\nscheme = \"cvode\"\ntolerance = 1e-18\n")),
             "line 7, column 13: integrator.tolerance: a tolerance of 1e-18");
  EXPECT_HAS(fault(square("[integrator]\nstepp = 1\n")), "did you mean 'step'?");
}

TEST(Integrator, StepsAreCountedInDoubles) {
  const std::string text = well + "[integrator]\nstep = 1e-6\n";
  EXPECT_HAS(fault(text + "[run]\nt_max = 1e10\n"),
             "line 7, column 9: run.t_max: t_max = 1e+10 is 1e+16 steps of 1e-06: steps are "
             "counted up to 2^52");
  EXPECT_EQ(read(text + "[run]\nt_max = 1e9\n").run.t_max, 1e9);
}

TEST(Integrator, StepsThatTurnTooFarAreRefusedAtWalls) {
  const std::string rest =
      "[[potential]]\nkind = \"harmonic\"\n[field]\nB = 30\n[integrator]\nstep = 0.05\n";
  EXPECT_HAS(fault(start + square(rest)),
             "integrator.step: the magnetic field turns the velocity by 1.5 within a step");
  EXPECT_EQ(fault(start + rest), "no fault");
}

}  // namespace
}  // namespace carom::tests
