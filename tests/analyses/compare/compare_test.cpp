// Integrators compared: measured orders, reversal and areas are what the table of schemes states.
#include "carom/analyses/compare.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "analyses/compare/orders.hpp"
#include "analyses/compare/precise_orbit.hpp"
#include "analyses/compare/precise_path.hpp"
#include "analyses/systems.hpp"
#include "carom/base/error.hpp"
#include "carom/integrators/scheme.hpp"

namespace carom {
namespace {

std::string henon_heiles(const char* omega) {
  return std::string("[particles]\nenergy = 0.125\n[field]\nB = ") + omega + R"(
[initial]
kind = "point"
position = [0.1, -0.2]
velocity = [0.8, 0.6]
[[potential]]
kind = "henon-heiles"
[integrator]
step = 0.1
)";
}

std::vector<std::string> fixed_schemes() {
  std::vector<std::string> names;
  for (const Scheme& scheme : schemes()) names.emplace_back(scheme.name);
  return names;
}

class OfField : public testing::TestWithParam<const char*> {};

TEST_P(OfField, EverySchemeIsMeasuredAsItIsStated) {
  const System system = make_system(henon_heiles(GetParam()));
  const Comparison result = compare(system, {.schemes = fixed_schemes(), .t_max = 6.0});
  ASSERT_EQ(result.schemes.size(), schemes().size());
  EXPECT_LT(result.reference_error, 1e-9);
  for (const ComparedScheme& scheme : result.schemes) {
    SCOPED_TRACE(scheme.name);
    const Scheme& stated = find_scheme(scheme.name);
    ASSERT_TRUE(scheme.measured.slope) << scheme.measured.reason;
    EXPECT_NEAR(scheme.measured.slope->value, stated.order,
                std::max(scheme.measured.slope->error, 0.02));
    EXPECT_LT(scheme.measured.slope->error, 1.0);
    ASSERT_TRUE(scheme.areas);
    // Without a field the magnetic schemes are velocity Verlet, or made of it.
    const bool field = std::string(GetParam()) != "0";
    if (field && !stated.symplectic()) {
      EXPECT_GT(scheme.areas->value, 100.0 * scheme.areas->error);
    } else {
      EXPECT_LE(scheme.areas->value, 4.0 * scheme.areas->error);
    }
    if (scheme.reversible && (field || stated.form != Scheme::Form::spreiter_walter)) {
      EXPECT_EQ(*scheme.reversible, stated.symmetric());
    }
  }
}

// A harmonic well in a field: the modes turn with omega/2 +- sqrt(omega^2/4 + 1), and the state is
// known in closed form.
TEST(Compare, TheReferenceHasMoreDigitsThanDoubles) {
  const System system = make_system(R"(
[particles]
energy = 0.625
[field]
B = 1.5
[initial]
kind = "point"
position = [1, 0]
velocity = [0, 0.5]
[[potential]]
kind = "harmonic"
omega = 1
[integrator]
step = 0.05
)");
  const double t = 8.0;
  const analyses::Runs runs(system, 0, {});
  const auto orbit =
      analyses::precise_orbit(runs, "mclachlan-ss17", 0.00625, t, {.size = 1.0, .speed = 0.5});
  ASSERT_TRUE(orbit);
  EXPECT_LT(orbit->error, 1e-15);
  // x + i y = a exp(i p t) + b exp(i q t); p and q of z'' = -z - i B z'.
  const long double fast = -0.75L + std::sqrt(0.75L * 0.75L + 1.0L),
                    slow = -0.75L - std::sqrt(0.75L * 0.75L + 1.0L);
  const long double a = (0.5L - slow) / (fast - slow), b = 1.0L - a;
  for (int k = 0; k < 8; ++k) {
    const long double now = t * (9 + k) / 16;
    const analyses::PlaneState& state = orbit->states[static_cast<std::size_t>(k)].front();
    EXPECT_NEAR(state.position.x,
                static_cast<double>(a * std::cos(fast * now) + b * std::cos(slow * now)), 3e-16);
    EXPECT_NEAR(state.position.y,
                static_cast<double>(a * std::sin(fast * now) + b * std::sin(slow * now)), 3e-16);
  }
  const Comparison result = compare(system, {.schemes = {"velocity-verlet"}, .t_max = t});
  EXPECT_EQ(result.reference, "mclachlan-ss17 in 34 digits");
  ASSERT_EQ(result.end.size(), 1u);
  EXPECT_NEAR(result.end[0].x, static_cast<double>(a * std::cos(fast * t) + b * std::cos(slow * t)),
              3e-16);
  EXPECT_NEAR(result.end[0].vy,
              static_cast<double>(a * fast * std::cos(fast * t) + b * slow * std::cos(slow * t)),
              1e-15);
}

// A cone has no slope at its tip: formulas give no number there.
TEST(Compare, WhereAForceHasNoValueThereAreNo34Digits) {
  const System system = make_system(R"(
[initial]
kind = "point"
position = [0, 0]
velocity = [0.5, 0.25]
[[potential]]
kind = "soft-circle"
height = 1
radius = 1
softness = 0.125
[integrator]
step = 0.01
)");
  const analyses::Runs runs(system, 0, {});
  analyses::PreciseMotion motion(runs, find_scheme("mclachlan-ss17"));
  EXPECT_FALSE(motion.follow(motion.start(), 0.5, 4, {}));
}

// Forces that jump have no order of eight: differences that fall by chance tell no error.
TEST(Compare, AReferenceBesideKinksStaysInDoubles) {
  const System system = make_system(R"toml(
[initial]
kind = "point"
position = [0.482, 0.372]
velocity = [-0.243565, 0.969885]
[[potential]]
kind = "expression"
expression = "abs(x) + abs(y)"
[integrator]
step = 0.001
)toml");
  const Comparison result = compare(system, {.schemes = {"velocity-verlet"}, .t_max = 2.0});
  EXPECT_EQ(result.reference, "mclachlan-ss17");
  EXPECT_GT(result.reference_error, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Compare, OfField, testing::Values("0", "1.5"));

TEST(Compare, FreeParticlesAreComparedWithExactFlights) {
  System system = make_system(magnetic_square);
  const Comparison result =
      compare(system, {.schemes = {"velocity-verlet", "blanes-moan-srkn11b"}, .trajectory = 3});
  EXPECT_TRUE(result.exact);
  EXPECT_GT(result.hits, 0u);
  for (const ComparedScheme& scheme : result.schemes) {
    EXPECT_FALSE(scheme.measured.slope);  // the drift is the exact flight
    for (const ComparedRun& run : scheme.runs) {
      EXPECT_LT(run.error_state, 1e-9);
      EXPECT_TRUE(run.same_hits);
      EXPECT_LT(run.error_hit_time, 1e-9);
    }
  }
}

TEST(Compare, HitsUnderForcesAreMetWithTheOrderOfTheScheme) {
  const System system = make_system(R"(
[table]
shape = "circle"
radius = 1
[particles]
energy = 2
[initial]
kind = "point"
position = [0.2, 0.1]
velocity = [0.3, 1]
[[potential]]
kind = "harmonic"
omega = 1
[integrator]
step = 0.01
)");
  const Comparison result =
      compare(system, {.schemes = {"velocity-verlet"}, .steps = {0.005, 0.02, 0.01}, .t_max = 6.0});
  const ComparedScheme& scheme = result.schemes.front();
  ASSERT_EQ(scheme.runs.size(), 3u);
  EXPECT_EQ(scheme.runs.front().step, 0.02);  // the longest first
  EXPECT_GT(result.hits, 3u);
  for (std::size_t k = 1; k < 3; ++k) {
    EXPECT_TRUE(scheme.runs[k].same_hits);
    EXPECT_NEAR(scheme.runs[k - 1].error_hit_time / scheme.runs[k].error_hit_time, 4.0, 1.0);
    EXPECT_GT(scheme.runs[k].force_evaluations, scheme.runs[k - 1].force_evaluations);
  }
}

TEST(Compare, TheCheapestNeedsTheLeastOfAll) {
  const System system = make_system(henon_heiles("0"));
  const Comparison result = compare(
      system, {.schemes = {"velocity-verlet", "forest-ruth-4", "blanes-moan-srkn6b", "arkode"},
               .t_max = 8.0,
               .error = 1e-5});
  ASSERT_TRUE(result.cheapest);
  EXPECT_EQ(result.t, 8.0);
  const double least = result.schemes[*result.cheapest].work->force_evaluations;
  for (const ComparedScheme& scheme : result.schemes) {
    if (!scheme.work) continue;
    EXPECT_GE(scheme.work->force_evaluations, least);
    // The work lies between that of two runs, whose errors are on both sides of the wanted one.
    const auto good = std::find_if(scheme.runs.begin(), scheme.runs.end(),
                                   [](const ComparedRun& run) { return run.error_state <= 1e-5; });
    ASSERT_NE(good, scheme.runs.end());
    EXPECT_LE(scheme.work->force_evaluations, static_cast<double>(good->force_evaluations));
  }
}

TEST(Compare, StepsThatMissForcesAreNamed) {
  const System system = make_system(R"(
[table]
shape = "rectangle"
width = 2
height = 2
[particles]
speed = 1
[initial]
kind = "point"
position = [0.3, 1]
velocity = [1, 0.02]
[[potential]]
kind = "gaussian"
height = 0.3
width = 0.05
centers = [[1, 1]]
[integrator]
step = 0.005
)");
  const Comparison result =
      compare(system, {.schemes = {"velocity-verlet"}, .steps = {0.005, 0.5}, .t_max = 1.5});
  EXPECT_TRUE(result.schemes.front().runs.front().failed());
  EXPECT_FALSE(result.schemes.front().runs.back().failed());
}

// There is no way from the end of the last whole step back to that of the first one.
TEST(Compare, ASingleStepTellsNothingOfReversal) {
  const System system = make_system(henon_heiles("0"));
  const double step = 0.125;
  const auto scheme = [&](std::vector<double> steps) {
    return compare(system, {.schemes = {"ruth-3"}, .steps = std::move(steps), .t_max = 2.0 * step})
        .schemes.front();
  };
  const ComparedScheme alone = scheme({1.5 * step});
  EXPECT_FALSE(alone.reversible);
  EXPECT_TRUE(std::isnan(alone.runs.front().error_reversal));
  const ComparedScheme both = scheme({1.5 * step, 0.5 * step});
  ASSERT_TRUE(both.reversible);
  EXPECT_FALSE(*both.reversible);
}

// With --t-max it may be far beyond the time in which rounding is magnified to the size of all.
TEST(Compare, WhereRoundingIsAllNothingIsSaidOfReversal) {
  const System system = make_system(R"(
[table]
shape = "rectangle"
width = 1
height = 1
[particles]
energy = 0.5
[initial]
kind = "point"
position = [0.1, 0.2]
velocity = [0.6, 0.8]
[[potential]]
kind = "gaussian"
height = 3
width = 0.15
centers = [[0.5, 0.45]]
[integrator]
step = 0.01
)");
  const Comparison result =
      compare(system, {.schemes = {"velocity-verlet"}, .steps = {0.005}, .t_max = 24.0});
  EXPECT_GT(result.growth, 1e12);
  EXPECT_FALSE(result.schemes.front().reversible);
  EXPECT_FALSE(result.schemes.front().measured.slope);
}

TEST(Compare, OrbitsWithoutAnyErrorTellNoOrder) {
  std::vector<ComparedRun> runs(4);
  double step = 1.0;
  for (ComparedRun& run : runs) run.step = step *= 0.5;
  const MeasuredOrder order = analyses::measured_order(runs, std::vector<double>(runs.size()));
  EXPECT_FALSE(order.slope);
  EXPECT_EQ(order.reason, "its errors are those of rounding");
}

TEST(Compare, ErrorsThatGrowWithShorterStepsTellNoOrder) {
  std::vector<ComparedRun> runs(4);
  double step = 1.0, error = 1e-8;
  for (ComparedRun& run : runs) {
    run.step = step *= 0.5;
    run.error_state = error *= 2.0;
  }
  const MeasuredOrder order = analyses::measured_order(runs, {1e-12, 1e-12, 1e-12, 1e-12});
  EXPECT_FALSE(order.slope);
  EXPECT_EQ(order.reason, "its errors do not fall with the step");
}

// Far from where it started a position has fewer digits after the point.
TEST(Compare, RoundingIsThatOfThePositionsOnTheWay) {
  const System system = make_system(R"(
[initial]
kind = "point"
position = [0.3, 0.2]
velocity = [0.6, 0.8]
[[potential]]
kind = "linear"
force = [0, -1]
)");
  const Comparison result =
      compare(system, {.schemes = {"velocity-verlet"}, .steps = {1.0, 0.25, 0.1}, .t_max = 1000.0});
  EXPECT_EQ(result.reference, "mclachlan-ss17 in 34 digits");
  EXPECT_LT(result.reference_error, 1e-9);
  const ComparedScheme& verlet = result.schemes.front();
  EXPECT_TRUE(verlet.reversible.value_or(true));
  EXPECT_FALSE(verlet.measured.slope);
}

// Where one orbit is all that may be computed, there is no second one to tell its error.
TEST(Compare, AReferenceThatCostsTooMuchIsRefusedWithTheCost) {
  const System system = make_system(R"(
[particles]
count = 100
energy = 5e6
[initial]
kind = "rectangle"
min = [-200, -200]
max = [200, 200]
[[potential]]
kind = "harmonic"
omega = 1
[interaction]
kind = "coulomb"
[integrator]
step = 0.01
)");
  try {
    compare(system, {.schemes = {"velocity-verlet"}, .t_max = 0.25});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(error.problem().find("evaluations of a force"), std::string::npos) << error.problem();
  }
}

TEST(Compare, RefusesWhatHasNothingToCompare) {
  const System system = make_system(henon_heiles("0"));
  try {
    compare(system, {.schemes = {"velocity-verlot"}});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.nearest(), "velocity-verlet");
    EXPECT_EQ(error.place().key, "--schemes");
  }
  EXPECT_THROW(compare(system, {.schemes = {"ruth-3", "ruth-3"}}), InputError);
  const System discs = make_system(R"(
[table]
shape = "rectangle"
width = 4
height = 4
[particles]
count = 2
speed = 1
[interaction]
kind = "hard-discs"
radius = 0.1
)");
  EXPECT_THROW(compare(discs, {}), InputError);
}

}  // namespace
}  // namespace carom
