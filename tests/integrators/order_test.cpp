// The measured order of every scheme is its declared one: potentials and pairs, with and without
// field.
#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <string>

#include "../../validation/schemes/problems.hpp"
#include "high_precision.hpp"
#include "steppers.hpp"

namespace carom {
namespace {

using Real = HighPrecision;
using problems::Problem;

constexpr int coarse_steps = 48;  // over a time of 1; the second measurement takes twice as many

std::unique_ptr<Problem<Real>> make_problem(const std::string& kind, const char* omega) {
  if (kind == "HenonHeiles") return std::make_unique<problems::HenonHeiles<Real>>(omega);
  if (kind == "Well") return std::make_unique<problems::AnisotropicWell<Real>>(omega);
  return std::make_unique<problems::CoulombParticles<Real>>(omega);
}

Phase<Real> after_time_1(const Scheme& scheme, const Problem<Real>& problem, int steps) {
  const auto stepper = stepper_of<Real>(scheme, problem, problem.omega);
  return walk(*stepper, problem.start, Real(Real(1) / Real(steps)), steps);
}

const Phase<Real>& reference(const std::string& kind, const char* omega) {
  static std::map<std::string, Phase<Real>> made;
  Phase<Real>& phase = made[kind + omega];
  if (phase.position.empty())
    phase = after_time_1(find_scheme("kahan-li-8"), *make_problem(kind, omega), 320);
  return phase;
}

class OrderOf : public testing::TestWithParam<std::string> {};

TEST_P(OrderOf, IsTheDeclaredOne) {
  const Scheme& scheme = find_scheme(GetParam());
  for (const char* kind : {"HenonHeiles", "Well", "Coulomb"}) {
    for (const char* omega : {"0", "1.5"}) {
      SCOPED_TRACE(std::string(kind) + ", omega = " + omega);
      const auto problem = make_problem(kind, omega);
      const Phase<Real> truth = reference(kind, omega);
      const Real coarse = distance(after_time_1(scheme, *problem, coarse_steps), truth);
      const Real fine = distance(after_time_1(scheme, *problem, 2 * coarse_steps), truth);
      const double order = static_cast<double>(log2(coarse / fine));
      RecordProperty(std::string(kind) + omega, std::to_string(order));
      EXPECT_NEAR(order, scheme.order, 0.05);
    }
  }
}

std::vector<std::string> names() {
  std::vector<std::string> list;
  for (const Scheme& scheme : schemes()) list.emplace_back(scheme.name);
  return list;
}

INSTANTIATE_TEST_SUITE_P(Schemes, OrderOf, testing::ValuesIn(names()), [](const auto& made) {
  std::string name = made.param;
  std::erase(name, '-');
  return name;
});

}  // namespace
}  // namespace carom
