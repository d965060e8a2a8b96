// The order conditions of Runge–Kutta–Nyström methods, to all digits of the coefficients: a
// convergence test does not see the last ones.
//
// A kick at the time c (sum of the drifts before) with weight b sees the earlier ones by b_j (c_i -
// c_j). For every tree, that is a derivative of the force with m arguments v and the others forces
// in turn, the weighted sum over the kicks must be what the exact motion gives.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "high_precision.hpp"
#include "integrators/stages.hpp"

namespace carom {

using namespace integrators;

namespace {

using Real = HighPrecision;

struct Tree {
  int velocities = 0;
  std::vector<Tree> forces;

  int order() const {
    int sum = 1 + velocities;
    for (const Tree& t : forces) sum += 1 + t.order();
    return sum;
  }
  /// The exact motion's value at time 1, divided by the power of time.
  Real exact() const {
    Real product(1);
    for (const Tree& t : forces) product = product * t.exact() / Real(t.order() * (t.order() + 1));
    return product;
  }
};

struct Kicks {
  std::vector<Real> time, weight;
  Real end{0};

  explicit Kicks(const Scheme& scheme) {
    for (const Stage<Real>& s : stages_of<Real>(scheme)) {
      if (s.kind == Stage<Real>::Kind::kick) {
        time.push_back(end);
        weight.push_back(s.coefficient);
      } else {
        end = end + s.coefficient;
      }
    }
  }
  std::vector<Real> values(const Tree& tree) const {
    std::vector<Real> product(time.size(), Real(1));
    for (std::size_t i = 0; i < time.size(); ++i)
      for (int k = 0; k < tree.velocities; ++k) product[i] = product[i] * time[i];
    for (const Tree& inner : tree.forces) {
      const std::vector<Real> value = values(inner);
      for (std::size_t i = 0; i < time.size(); ++i) {
        Real sum(0);
        for (std::size_t j = 0; j < i; ++j) sum = sum + weight[j] * (time[i] - time[j]) * value[j];
        product[i] = product[i] * sum;
      }
    }
    return product;
  }
};

/// All trees of an order; the inner ones from `least` on, so that none comes twice.
void add_trees(int rest, Tree tree, int least_order, std::size_t least_index,
               std::vector<Tree>& list) {
  static std::vector<std::vector<Tree>> known;
  Tree leaf = tree;
  leaf.velocities = rest;
  list.push_back(leaf);
  for (int order = least_order; order + 1 <= rest; ++order) {
    while (static_cast<int>(known.size()) <= order) {
      std::vector<Tree> next;
      if (!known.empty()) add_trees(static_cast<int>(known.size()) - 1, Tree{}, 1, 0, next);
      known.push_back(next);
    }
    const std::vector<Tree> inner = known[static_cast<std::size_t>(order)];
    for (std::size_t k = order == least_order ? least_index : 0; k < inner.size(); ++k) {
      Tree grown = tree;
      grown.forces.push_back(inner[k]);
      add_trees(rest - order - 1, grown, order, k, list);
    }
  }
}

std::vector<Tree> trees(int order) {
  std::vector<Tree> list;
  add_trees(order - 1, Tree{}, 1, 0, list);
  return list;
}

TEST(OrderConditions, TreesAreCounted) {
  // Nyström trees of order 1, 2, …
  const std::size_t counts[] = {1, 1, 2, 3, 6, 10, 20, 36};
  for (int order = 1; order <= 8; ++order) {
    EXPECT_EQ(trees(order).size(), counts[order - 1]) << order;
    for (const Tree& tree : trees(order)) EXPECT_EQ(tree.order(), order);
  }
}

TEST(OrderConditions, HoldToAllDigitsUpToTheOrderAndNotBeyond) {
  for (const Scheme& scheme : schemes()) {
    if (!scheme.symplectic()) continue;
    const Kicks kicks(scheme);
    const auto largest_residual = [&](int order) {
      Real largest(0);
      for (const Tree& tree : trees(order)) {
        const std::vector<Real> value = kicks.values(tree);
        Real velocity(0), position(0);
        for (std::size_t i = 0; i < value.size(); ++i) {
          velocity = velocity + kicks.weight[i] * value[i];
          position = position + kicks.weight[i] * (kicks.end - kicks.time[i]) * value[i];
        }
        largest = std::max<Real>(largest, abs(velocity - tree.exact() / Real(order)));
        if (order < scheme.order)
          largest =
              std::max<Real>(largest, abs(position - tree.exact() / Real(order * (order + 1))));
      }
      return largest;
    };
    for (int order = 1; order <= scheme.order; ++order) {
      EXPECT_LT(largest_residual(order), Real("1e-37")) << scheme.name << ", order " << order;
    }
    EXPECT_GT(largest_residual(scheme.order + 1), Real("1e-7")) << scheme.name;
  }
}

}  // namespace
}  // namespace carom
