// Roots beyond quadratics are times of flights: the same bits on any number of threads.
#include <gtest/gtest.h>

#include <random>
#include <thread>
#include <vector>

#include "algebraic_root.hpp"

namespace carom::geometry {
namespace {

std::vector<double> roots_of_quartics(unsigned seed) {
  std::mt19937_64 random(seed);
  std::vector<double> all;
  for (int i = 0; i < 400; ++i) {
    Polynomial p;
    for (int k = 0; k < 5; ++k)
      p.push_back(Dyadic(0x1p-52 * static_cast<double>(random() >> 11) - 1.0));
    for (const RealRoot& root : real_roots(p)) all.push_back(approximate(root.value));
  }
  return all;
}

TEST(RootsOnThreads, HaveTheSameBits) {
  constexpr unsigned threads = 4;
  std::vector<std::vector<double>> one(threads), many(threads);
  for (unsigned k = 0; k < threads; ++k) one[k] = roots_of_quartics(k);
  std::vector<std::thread> running;
  for (unsigned k = 0; k < threads; ++k)
    running.emplace_back([&, k] { many[k] = roots_of_quartics(k); });
  for (std::thread& thread : running) thread.join();
  EXPECT_GT(one[0].size(), 400u);
  EXPECT_EQ(one, many);
}

}  // namespace
}  // namespace carom::geometry
