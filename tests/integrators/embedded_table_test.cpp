// The table of the adaptive Runge–Kutta scheme: order conditions to all digits, and an estimate
// that sees all of a step.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "../../validation/schemes/problems.hpp"
#include "high_precision.hpp"
#include "integrators/arkode_stepper.hpp"
#include "integrators/embedded_table.hpp"
#include "steppers.hpp"

namespace carom {

using namespace integrators;

namespace {

using Real = HighPrecision;

/// A rooted tree: the branches at its root.
struct Tree {
  std::vector<Tree> branches;

  int order() const {
    int sum = 1;
    for (const Tree& t : branches) sum += t.order();
    return sum;
  }
  /// The exact weighted sum is 1 over this.
  Real density() const {
    Real product(order());
    for (const Tree& t : branches) product = product * t.density();
    return product;
  }
};

/// All trees of an order: branches are added in the order of the list of all smaller trees.
std::vector<Tree> trees(int order) {
  if (order == 1) return {Tree{}};
  std::vector<Tree> smaller;
  for (int k = 1; k < order; ++k)
    for (Tree& t : trees(k)) smaller.push_back(std::move(t));
  std::vector<Tree> found;
  const auto grow = [&](const auto& self, const Tree& tree, std::size_t from, int rest) -> void {
    if (rest == 0) found.push_back(tree);
    for (std::size_t k = from; k < smaller.size() && smaller[k].order() <= rest; ++k) {
      Tree next = tree;
      next.branches.push_back(smaller[k]);
      self(self, next, k, rest - smaller[k].order());
    }
  };
  grow(grow, Tree{}, 0, order - 1);
  return found;
}

struct Numbers {
  std::vector<Real> time, weight, embedded;
  std::vector<std::vector<Real>> stage;

  explicit Numbers(const EmbeddedTable& table)
      : time(of(table.time)), weight(of(table.weight)), embedded(of(table.embedded)) {
    for (const auto& row : table.stage) stage.push_back(of(row));
  }
  static std::vector<Real> of(const std::vector<std::string_view>& decimals) {
    std::vector<Real> list;
    for (const std::string_view text : decimals) list.push_back(Arithmetic<Real>::parse(text));
    return list;
  }
  std::vector<Real> values(const Tree& tree) const {
    std::vector<Real> product(time.size(), Real(1));
    for (const Tree& branch : tree.branches) {
      const std::vector<Real> inner = values(branch);
      for (std::size_t i = 0; i < product.size(); ++i) {
        Real sum(0);
        for (std::size_t j = 0; j < stage[i].size(); ++j) sum = sum + stage[i][j] * inner[j];
        product[i] = product[i] * sum;
      }
    }
    return product;
  }
};

Real largest_residual(const Numbers& table, const std::vector<Real>& weight, int order) {
  Real largest(0);
  for (const Tree& tree : trees(order)) {
    const std::vector<Real> value = table.values(tree);
    Real sum(0);
    for (std::size_t i = 0; i < value.size(); ++i) sum = sum + weight[i] * value[i];
    largest = std::max<Real>(largest, abs(sum - Real(1) / tree.density()));
  }
  return largest;
}

TEST(EmbeddedTable, TreesAreCounted) {
  const std::size_t counts[] = {1, 1, 2, 4, 9, 20, 48, 115, 286, 719};
  for (int order = 1; order <= 10; ++order) {
    EXPECT_EQ(trees(order).size(), counts[order - 1]) << order;
    for (const Tree& tree : trees(order)) EXPECT_EQ(tree.order(), order);
  }
}

TEST(EmbeddedTable, IsExplicitAndItsTimesAreRowSums) {
  const EmbeddedTable& table = verner_9_8();
  const Numbers numbers(table);
  ASSERT_EQ(table.stage.size(), table.time.size());
  ASSERT_EQ(table.weight.size(), table.time.size());
  ASSERT_EQ(table.embedded.size(), table.time.size());
  for (std::size_t i = 0; i < table.time.size(); ++i) {
    EXPECT_LE(table.stage[i].size(), i);
    Real sum(0);
    for (const Real& a : numbers.stage[i]) sum = sum + a;
    EXPECT_LT(abs(sum - numbers.time[i]), Real("1e-38")) << i;
  }
}

TEST(EmbeddedTable, OrderConditionsHoldToAllDigitsUpToTheOrderAndNotBeyond) {
  const EmbeddedTable& table = verner_9_8();
  const Numbers numbers(table);
  for (int order = 1; order <= table.order; ++order)
    EXPECT_LT(largest_residual(numbers, numbers.weight, order), Real("1e-37")) << order;
  EXPECT_GT(largest_residual(numbers, numbers.weight, table.order + 1), Real("1e-7"));
  for (int order = 1; order <= table.embedded_order; ++order)
    EXPECT_LT(largest_residual(numbers, numbers.embedded, order), Real("1e-37")) << order;
  EXPECT_GT(largest_residual(numbers, numbers.embedded, table.embedded_order + 1), Real("1e-7"));
}

TEST(EmbeddedTable, EstimateSeesAllOfTheStep) {
  // Between stages that it weighs no more than a quarter of the step is out of sight.
  const Numbers numbers(verner_9_8());
  std::vector<double> seen;
  for (std::size_t i = 0; i < numbers.time.size(); ++i)
    if (abs(numbers.weight[i] - numbers.embedded[i]) > Real("1e-3"))
      seen.push_back(static_cast<double>(numbers.time[i]));
  std::sort(seen.begin(), seen.end());
  EXPECT_EQ(seen.front(), 0.0);
  EXPECT_EQ(seen.back(), 1.0);
  for (std::size_t k = 1; k < seen.size(); ++k) EXPECT_LT(seen[k] - seen[k - 1], 0.25) << seen[k];
}

TEST(EmbeddedTable, StepsHaveItsOrder) {
  for (const char* omega : {"0", "1.5"}) {
    const problems::CoulombParticles<double> problem(omega);
    const auto fine = stepper_of<double>(find_scheme("kahan-li-8"), problem, problem.omega);
    ArkodeStepper stepper(problem, problem.omega, 0.5);
    Phase<double> whole, part;
    const double longest = stepper.step(problem.start, 1.0, whole);
    const auto error = [&](double duration) {
      EXPECT_LT(duration, longest);
      stepper.step(problem.start, duration, part);
      return distance(part, walk(*fine, problem.start, duration / 400, 400));
    };
    // One step errs by the order's next power.
    EXPECT_NEAR(std::log2(error(0.4) / error(0.2)), verner_9_8().order + 1, 0.6) << omega;
  }
}

TEST(EmbeddedTable, StepCostsItsStages) {
  const problems::HenonHeiles<double> problem("0");
  ArkodeStepper stepper(problem, problem.omega, 1e-10);
  Phase<double> phase = problem.start, next;
  for (int k = 0; k < 40; ++k) {
    stepper.step(phase, std::numeric_limits<double>::max(), next);
    std::swap(phase, next);
    if (k == 19) problem.evaluations = 0;
  }
  EXPECT_EQ(problem.evaluations, 20 * static_cast<long>(verner_9_8().time.size()));
}

}  // namespace
}  // namespace carom
