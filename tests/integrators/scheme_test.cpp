// The table: sums of coefficients, time symmetry, areas, reversal with the field turned round.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "../../validation/schemes/problems.hpp"
#include "carom/integrators/make_stepper.hpp"
#include "high_precision.hpp"
#include "steppers.hpp"

namespace carom {

using namespace integrators;

// Enough digits for Jacobians by differences.
using Precise = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<100>,
                                              boost::multiprecision::et_off>;
template <>
struct Arithmetic<Precise> {
  static Precise parse(std::string_view decimal) { return Precise(std::string(decimal)); }
  static SineCosine<Precise> turn(const Precise& angle) { return {sin(angle), cos(angle)}; }
};

namespace {

using Real = HighPrecision;
using problems::CoulombParticles;
using problems::Problem;

TEST(Schemes, EveryKindOfMotionTakesTheWholeStep) {
  for (const Scheme& scheme : schemes()) {
    std::map<Stage<Real>::Kind, Real> sum;
    for (const Stage<Real>& s : stages_of<Real>(scheme)) sum[s.kind] += s.coefficient;
    EXPECT_EQ(sum.size(), scheme.form == Scheme::Form::spreiter_walter ? 0u
                          : scheme.form == Scheme::Form::he            ? 3u
                                                                       : 2u);
    for (const auto& [kind, total] : sum) {
      EXPECT_LT(abs(total - 1), Real("2e-40")) << scheme.name << ": " << total.str();
    }
  }
}

TEST(Schemes, StagesInDoubleAreTheRoundedOnes) {
  for (const Scheme& scheme : schemes()) {
    const auto rounded = stages_of<double>(scheme);
    const auto exact = stages_of<Real>(scheme);
    ASSERT_EQ(rounded.size(), exact.size());
    for (std::size_t k = 0; k < exact.size(); ++k) {
      EXPECT_NEAR(rounded[k].coefficient, static_cast<double>(exact[k].coefficient), 2e-15)
          << scheme.name;
    }
  }
}

TEST(Schemes, NamesAreFoundAndNearOnesOffered) {
  std::vector<std::string> names;
  for (const Scheme& scheme : schemes()) {
    EXPECT_EQ(&find_scheme(std::string(scheme.name)), &scheme);
    EXPECT_EQ(std::count(names.begin(), names.end(), scheme.name), 0);
    EXPECT_FALSE(scheme.source.empty());
    names.emplace_back(scheme.name);
  }
  EXPECT_EQ(&find_scheme(""), &default_scheme());
  try {
    find_scheme("velocity-velet", Place{"a.toml", 3, 1, "integrator.scheme"});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.nearest(), "velocity-verlet");
    EXPECT_NE(error.expected().find("kahan-li-8"), std::string::npos);
    EXPECT_NE(error.expected().find("arkode"), std::string::npos);
  }
}

TEST(Schemes, StepsBackwardsUndoSymmetricOnesAlone) {
  const CoulombParticles<Real> problem("1.5");
  const Real step = Real(1) / 10;
  for (const Scheme& scheme : schemes()) {
    const auto stepper = stepper_of<Real>(scheme, problem, problem.omega);
    Phase<Real> there, back;
    stepper->step(problem.start, step, there);
    stepper->step(there, -step, back);
    EXPECT_EQ(distance(back, problem.start) < Real("1e-36"), scheme.symmetric()) << scheme.name;
  }
}

TEST(Schemes, ReversalNeedsTheFieldTurnedRound) {
  const CoulombParticles<Real> problem("1.5");
  std::vector<Real> opposite;
  for (const Real& omega : problem.omega) opposite.push_back(-omega);
  const Real step = Real(1) / 10;
  const auto reversed = [](Phase<Real> phase) {
    for (auto& v : phase.velocity) v = -v;
    return phase;
  };
  for (const Scheme& scheme : schemes()) {
    if (!scheme.symmetric()) continue;
    const auto forth = stepper_of<Real>(scheme, problem, problem.omega);
    const auto back = stepper_of<Real>(scheme, problem, opposite);
    const Phase<Real> turned = reversed(walk(*forth, problem.start, step, 5));
    EXPECT_LT(distance(reversed(walk(*back, turned, step, 5)), problem.start), Real("1e-35"))
        << scheme.name;
    EXPECT_GT(distance(reversed(walk(*forth, turned, step, 5)), problem.start), Real("1e-2"))
        << scheme.name;
  }
}

using Matrix = std::vector<std::vector<Precise>>;

Precise& coordinate(Phase<Precise>& phase, std::size_t k) {
  const std::size_t n = phase.position.size();
  auto& vector = k < 2 * n ? phase.position[k / 2] : phase.velocity[k / 2 - n];
  return k % 2 == 0 ? vector.x : vector.y;
}

Matrix jacobian(Stepper<Precise>& stepper, const Phase<Precise>& at, const Precise& step) {
  const std::size_t size = 4 * at.position.size();
  const Precise shift("1e-30");
  Matrix j(size, std::vector<Precise>(size));
  for (std::size_t c = 0; c < size; ++c) {
    Phase<Precise> plus = at, minus = at, to_plus, to_minus;
    coordinate(plus, c) += shift;
    coordinate(minus, c) -= shift;
    stepper.step(plus, step, to_plus);
    stepper.step(minus, step, to_minus);
    for (std::size_t r = 0; r < size; ++r)
      j[r][c] = (coordinate(to_plus, r) - coordinate(to_minus, r)) / (2 * shift);
  }
  return j;
}

// dx dvx + dy dvy - omega dx dy: the form that a = F + omega J v keeps, in positions and
// velocities.
Matrix symplectic_form(const std::vector<Precise>& omega) {
  const std::size_t n = omega.size();
  Matrix s(4 * n, std::vector<Precise>(4 * n, Precise(0)));
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 2 * i; k < 2 * i + 2; ++k) {
      s[k][2 * n + k] = 1;
      s[2 * n + k][k] = -1;
    }
    s[2 * i][2 * i + 1] = -omega[i];
    s[2 * i + 1][2 * i] = omega[i];
  }
  return s;
}

Precise violation(const Matrix& j, const Matrix& s) {
  Precise most(0);
  for (std::size_t a = 0; a < j.size(); ++a) {
    for (std::size_t b = 0; b < j.size(); ++b) {
      Precise sum = -s[a][b];
      for (std::size_t r = 0; r < j.size(); ++r)
        for (std::size_t c = 0; c < j.size(); ++c)
          if (s[r][c] != 0) sum += j[r][a] * s[r][c] * j[c][b];
      most = std::max<Precise>(most, abs(sum));
    }
  }
  return most;
}

Precise determinant(Matrix m) {
  Precise product(1);
  for (std::size_t k = 0; k < m.size(); ++k) {
    std::size_t pivot = k;
    for (std::size_t r = k; r < m.size(); ++r)
      if (abs(m[r][k]) > abs(m[pivot][k])) pivot = r;
    if (pivot != k) product = -product;
    std::swap(m[pivot], m[k]);
    product *= m[k][k];
    for (std::size_t r = k + 1; r < m.size(); ++r) {
      const Precise factor = m[r][k] / m[k][k];
      for (std::size_t c = k; c < m.size(); ++c) m[r][c] -= factor * m[k][c];
    }
  }
  return product;
}

TEST(Schemes, KeepAreasOrVolumesAsDeclared) {
  const CoulombParticles<Precise> problem("1.5");
  const Matrix form = symplectic_form(problem.omega);
  for (const Scheme& scheme : schemes()) {
    const auto stepper = stepper_of<Precise>(scheme, problem, problem.omega);
    const Matrix j = jacobian(*stepper, problem.start, Precise(1) / 7);
    EXPECT_EQ(violation(j, form) < Precise("1e-25"), scheme.symplectic()) << scheme.name;
    const bool keeps_volume = abs(determinant(j) - 1) < Precise("1e-25");
    EXPECT_EQ(keeps_volume, scheme.form != Scheme::Form::spreiter_walter) << scheme.name;
  }
}

}  // namespace
}  // namespace carom
