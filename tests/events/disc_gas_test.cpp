// Gases of hard discs: what is conserved over many contacts, the way back, and the pressure.
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <utility>

#include "events/discs.hpp"

#include "carom/events/world.hpp"
#include "soak.hpp"

namespace carom::tests {
namespace {

/// Counts contacts and adds up their virial.
struct Virial : Observer {
  long contacts = 0;
  double sum = 0.0;
  void contact(const ContactEvent& c) override {
    ++contacts;
    sum += c.transfer * std::sqrt(dot(c.separation, c.separation));
  }
};

TEST(DiscGas, MomentumAndEnergyHaveNoTrend) {
  const Table table = torus({10, 0}, {0, 10});
  std::vector<Disc> discs = square_gas(10, 10.0, 0.3, 1);
  for (std::size_t i = 0; i < discs.size(); i += 2) discs[i].particle.mass = 3.0;
  Gas gas(table, discs);
  const double energy = gas.energy();
  const Vector momentum = gas.momentum();
  double size = 0.0;
  for (const Disc& d : discs)
    size += d.particle.mass * std::sqrt(dot(d.state.velocity, d.state.velocity));
  const long most = soak() ? 1'000'000 : 30'000;
  Virial seen;
  double n = 0, st = 0, se = 0, stt = 0, ste = 0, t = 0;
  while (seen.contacts < most) {
    gas.world.run_until(t += 2.0, seen);
    const double error = gas.energy() / energy - 1.0;
    EXPECT_LT(std::fabs(error), 1e-12);
    const Vector lost = gas.momentum() - momentum;
    EXPECT_LT(std::sqrt(dot(lost, lost)), 1e-12 * size);
    n += 1, st += t, se += error, stt += t * t, ste += t * error;
  }
  const double slope = (n * ste - st * se) / (n * stt - st * st);
  EXPECT_LT(std::fabs(slope) * t, 1e-13);
}

TEST(DiscGas, TheWayBackLeadsToTheStart) {
  // Errors grow by a factor of path over radius a contact; few discs, far apart, come back after
  // 100 contacts.
  const Table table = loop({Circle{{0, 0}, 1.0, true}});
  const std::vector<Disc> discs{disc_at({-0.3, 0.01}, {1, 0.2}, 0.25),
                                disc_at({0.3, 0.0}, {-0.4, 0.1}, 0.25)};
  for (const double omega : {0.0, 0.75}) {
    std::vector<Disc> there = discs;
    for (Disc& d : there) d.particle.omega = omega;
    Gas gas(table, there);
    Virial seen;
    double t = 0.0;
    while (seen.contacts < 10) gas.world.run_until(t += 0.25, seen);
    std::vector<Disc> back = there;
    for (int i = 0; i < 2; ++i) {
      const State s = gas.world.state_at(i, t);
      back[static_cast<std::size_t>(i)] = disc_at(s.position, -s.velocity, 0.25, 1.0, -omega);
    }
    Gas home(table, back);
    Virial again;
    home.world.run_until(t, again);
    EXPECT_EQ(again.contacts, seen.contacts);
    for (int i = 0; i < 2; ++i) {
      const Vector x = home.world.state_at(i, t).position,
                   x0 = discs[static_cast<std::size_t>(i)].state.position;
      EXPECT_NEAR(x.x, x0.x, 1e-6);
      EXPECT_NEAR(x.y, x0.y, 1e-6);
    }
  }
}

TEST(DiscGas, ARowOfDiscsComesBackAfterManyContacts) {
  // Along a line nothing is amplified: 100 contacts and more, and back to rounding. Unequal masses.
  const Table table = square();
  std::vector<Disc> row;
  for (int i = 0; i < 4; ++i)
    row.push_back(
        disc_at({0.2 * (i + 1), 0.5}, {i % 2 ? -0.3 : 0.7 - 0.1 * i, 0}, 0.03, 1.0 + 0.7 * i));
  Gas gas(table, row);
  Virial seen;
  double t = 0.0;
  while (seen.contacts < 100) gas.world.run_until(t += 0.25, seen);
  std::vector<Disc> back = row;
  for (std::size_t i = 0; i < row.size(); ++i) {
    const State s = gas.world.state_at(static_cast<int>(i), t);
    back[i].state = start(s.position, -s.velocity);
  }
  Gas home(table, back);
  Virial again;
  home.world.run_until(t, again);
  EXPECT_EQ(again.contacts, seen.contacts);
  for (std::size_t i = 0; i < row.size(); ++i)
    EXPECT_NEAR(home.world.state_at(static_cast<int>(i), t).position.x, row[i].state.position.x,
                1e-11);
}

TEST(DiscGas, SamplingAndPausingChangeNoBit) {
  const Table table = torus({6, 0}, {3, 5.2});
  std::vector<Disc> discs = square_gas(6, 4.5, 0.3, 5);
  for (std::size_t i = 0; i < discs.size(); ++i) discs[i].particle.omega = i % 5 ? 0.4 : 0.0;
  Gas whole(table, discs), parts(table, discs);
  ContactRecorder a, b;
  parts.world.sample_every(0.1);
  whole.world.run_until(30.0, a);
  for (int k = 1; k <= 300; ++k) parts.world.run_until(0.1 * k, b);
  // … and a run that is taken up from the states of its discs.
  Gas early(table, discs);
  ContactRecorder c;
  early.world.run_until(12.0, c);
  std::vector<Disc> stored = discs;
  for (std::size_t i = 0; i < stored.size(); ++i)
    stored[i].state = early.world.state(static_cast<int>(i));
  Gas late(table, stored);
  late.world.run_until(30.0, c);
  ASSERT_GT(a.contacts.size(), 300u);
  ASSERT_EQ(a.contacts.size(), b.contacts.size());
  ASSERT_EQ(a.contacts.size(), c.contacts.size());
  for (std::size_t i = 0; i < a.contacts.size(); ++i) {
    EXPECT_EQ(a.contacts[i].time, b.contacts[i].time);
    EXPECT_EQ(a.contacts[i].first_after, b.contacts[i].first_after);
    EXPECT_EQ(a.contacts[i].time, c.contacts[i].time);
    EXPECT_EQ(a.contacts[i].second_after, c.contacts[i].second_after);
  }
}

TEST(DiscGas, BinsFindWhatAskingAllFinds) {
  // The same gas twice: once alone, in bins; once beside a far disc so large that no bins fit.
  const Table table = plane();
  std::vector<Disc> discs = square_gas(8, 8.0, 0.4, 11);
  for (std::size_t i = 0; i < discs.size(); ++i) discs[i].particle.omega = i % 3 ? 2.0 : -1.0;
  std::vector<Disc> beside = discs;
  beside.push_back(disc_at({1000, 0}, {0, 0}, 500));
  Gas binned(table, discs), all(table, beside);
  ContactRecorder a, b;
  binned.world.run_until(20.0, a);
  all.world.run_until(20.0, b);
  ASSERT_GT(a.contacts.size(), 200u);
  ASSERT_EQ(a.contacts.size(), b.contacts.size());
  for (std::size_t i = 0; i < a.contacts.size(); ++i)
    EXPECT_EQ(a.contacts[i].time, b.contacts[i].time) << i;
}

TEST(DiscGas, PressureOfTwoDiscsOnATorusIsExact) {
  // Two discs on a torus of area A: Z = 1 + pi sigma^2 / (2 (A - pi sigma^2)).
  const Table table = torus({1, 0}, {0, 1});
  const double sigma = 0.3, pi = 3.141592653589793;
  double sum = 0.0, square_sum = 0.0;
  const int runs = soak() ? 4000 : 200;
  for (int k = 0; k < runs; ++k) {
    RandomStream random(21, Purpose::initial_state, static_cast<std::uint64_t>(k));
    Vector x, v{random.symmetric(), random.symmetric()};
    do {
      x = {0.5 * random.symmetric(), 0.5 * random.symmetric()};
    } while (dot(x, x) < sigma * sigma);
    Gas gas(table, {disc_at({0, 0}, v, sigma / 2), disc_at(x, -v, sigma / 2)});
    Virial seen;
    const double t = 100.0 / std::sqrt(dot(v, v));
    gas.world.run_until(t, seen);
    const double z = 1.0 + seen.sum / t / (2.0 * dot(v, v)) / 2.0;
    sum += z;
    square_sum += z * z;
  }
  const double mean = sum / runs, error = std::sqrt((square_sum / runs - mean * mean) / runs);
  EXPECT_NEAR(mean, 1.0 + pi * sigma * sigma / (2.0 * (1.0 - pi * sigma * sigma)), 3.0 * error);
  EXPECT_LT(error, 0.01);
}

TEST(DiscGas, CompressibilityFollowsTheVirialSeries) {
  // Clisby & McCoy 2006, table 1; the correction for N discs is derived in
  // docs/physics/hard-discs.md.
  const std::vector<double> b{1.0,       0.78200444, 0.53223180, 0.33355604, 0.1988425,
                              0.1148728, 0.0649930,  0.0362193,  0.0199537};
  const double eta = 0.3, pi = 3.141592653589793;
  const int across = 16, count = across * across;
  double expected = 1.0, first = 1.0, second = 0.0, power = 1.0;
  for (std::size_t i = 0; i < b.size(); ++i) {
    const double k = static_cast<double>(i + 1);
    power *= 2.0 * eta;
    expected += b[i] * power;
    first += (k + 1.0) * b[i] * power;
    second += k * (k + 1.0) * b[i] * power;
  }
  expected -= second / first / (2.0 * count);
  const Table table = torus({16, 0}, {0, 16});
  Gas gas(table, square_gas(across, 16.0, std::sqrt(eta / pi), 3));
  const double energy = gas.energy(), speed = std::sqrt(2.0 * energy / count);
  Virial seen;
  double t = 40.0 / speed;
  gas.world.run_until(t, seen);
  const int blocks = soak() ? 1000 : 20;
  const double length = 10.0 / speed;
  double sum = 0.0, square_sum = 0.0;
  for (int k = 0; k < blocks; ++k) {
    const double before = seen.sum;
    gas.world.run_until(t += length, seen);
    const double z = 1.0 + (seen.sum - before) / (2.0 * energy * length) * (count - 1.0) / count;
    sum += z;
    square_sum += z * z;
  }
  const double mean = sum / blocks,
               error = std::sqrt((square_sum / blocks - mean * mean) / (blocks - 1));
  EXPECT_NEAR(mean, expected, 3.0 * error);
  EXPECT_LT(error, 0.01);
}

}  // namespace
}  // namespace carom::tests
