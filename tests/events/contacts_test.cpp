// Hard discs in the event loop.
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "carom/base/error.hpp"
#include "carom/events/world.hpp"
#include "events/discs.hpp"
#include "motion/free_motion.hpp"

namespace carom::tests {
namespace {

TEST(Contacts, TwoDiscsHeadOnExchangeTheirVelocities) {
  const Table table = plane();
  Gas gas(table, {disc_at({-2, 0}, {1, 0}, 0.5), disc_at({2, 0}, {-0.5, 0}, 0.5)});
  ContactRecorder seen;
  gas.world.run_until(10.0, seen);
  ASSERT_EQ(seen.contacts.size(), 1u);
  EXPECT_EQ(seen.contacts[0].time.value(), 2.0);
  EXPECT_EQ(seen.contacts[0].first_after, Vector(-0.5, 0));
  EXPECT_EQ(seen.contacts[0].second_after, Vector(1, 0));
  EXPECT_EQ(seen.contacts[0].transfer, 1.5);
  EXPECT_EQ(seen.contacts[0].separation, Vector(-1, 0));
  EXPECT_TRUE(seen.ends.empty());
  EXPECT_DOUBLE_EQ(gas.world.state_at(0, 10.0).position.x, 0.0 - 0.5 * 8);
}

TEST(Contacts, AnObliqueContactOfUnequalDiscs) {
  // Centres 3-4-5 at contact: the relative velocity (1, 0) has 4/5 along the line of centres.
  const Table table = plane();
  Gas gas(table, {disc_at({-4, 0}, {1, 0}, 0.75, 3.0), disc_at({0, 0.6}, {0, 0}, 0.25, 1.0)});
  ContactRecorder seen;
  gas.world.run_until(10.0, seen);
  ASSERT_EQ(seen.contacts.size(), 1u);
  EXPECT_DOUBLE_EQ(seen.contacts[0].time.value(), 4.0 - 0.8);
  // n = (0.8, 0.6); J = 2 mu (v.n) = 2 (3/4) 0.8 = 1.2.
  EXPECT_DOUBLE_EQ(seen.contacts[0].transfer, 1.2);
  EXPECT_NEAR(seen.contacts[0].first_after.x, 1 - 1.2 / 3 * 0.8, 1e-15);
  EXPECT_NEAR(seen.contacts[0].first_after.y, -1.2 / 3 * 0.6, 1e-15);
  EXPECT_NEAR(seen.contacts[0].second_after.x, 1.2 * 0.8, 1e-15);
  EXPECT_NEAR(seen.contacts[0].second_after.y, 1.2 * 0.6, 1e-15);
}

TEST(Contacts, NewtonsCradleIsExact) {
  const Table table = plane();
  for (const double gap : {0.0, 0.01}) {
    std::vector<Disc> row{disc_at({-3, 0.7}, {1, 0}, 0.1)};
    for (int i = 0; i < 5; ++i) row.push_back(disc_at({0.1 * i * (2 + gap), 0.7}, {0, 0}, 0.1));
    Gas gas(table, row);
    ContactRecorder seen;
    gas.world.run_until(20.0, seen);
    ASSERT_EQ(seen.contacts.size(), 5u);
    for (std::size_t i = 0; i < 5; ++i) {
      EXPECT_EQ(seen.contacts[i].first, static_cast<int>(i));
      EXPECT_EQ(seen.contacts[i].second, static_cast<int>(i) + 1);
      EXPECT_EQ(gas.world.state(static_cast<int>(i)).velocity, Vector(0, 0));
    }
    EXPECT_EQ(gas.world.state(5).velocity, Vector(1, 0));
  }
}

TEST(Contacts, AHeavyDiscDrivesARowAsTheClosedFormSays) {
  // From disc to disc of masses m, n: v -> 2 m v / (m + n).
  const Table table = plane();
  std::vector<double> masses{8, 4, 2, 1};
  std::vector<Disc> row;
  for (std::size_t i = 0; i < masses.size(); ++i)
    row.push_back(
        disc_at({2.0 * static_cast<double>(i), 0}, {i == 0 ? 1.0 : 0.0, 0}, 0.25, masses[i]));
  Gas gas(table, row);
  ContactRecorder seen;
  gas.world.run_until(100.0, seen);
  EXPECT_NEAR(gas.world.state(3).velocity.x, 64.0 / 27, 1e-14);
  EXPECT_NEAR(gas.world.state(2).velocity.x, 16.0 / 9 / 3, 1e-14);
  EXPECT_NEAR(gas.world.state(1).velocity.x, 4.0 / 3 / 3, 1e-14);
  EXPECT_NEAR(gas.world.state(0).velocity.x, 1.0 / 3, 1e-14);
}

TEST(Contacts, SimultaneousContactsComeInTheOrderOfTheirDiscs) {
  const Table table = plane();
  // Three pairs that meet at the same time, listed in disorder.
  Gas gas(table, {disc_at({-2, 10}, {1, 0}, 0.5), disc_at({-2, 0}, {1, 0}, 0.5),
                  disc_at({2, 5}, {-1, 0}, 0.5), disc_at({2, 0}, {-1, 0}, 0.5),
                  disc_at({-2, 5}, {1, 0}, 0.5), disc_at({2, 10}, {-1, 0}, 0.5)});
  ContactRecorder seen;
  gas.world.run_until(10.0, seen);
  ASSERT_EQ(seen.contacts.size(), 3u);
  EXPECT_EQ(seen.contacts[0].first, 0);
  EXPECT_EQ(seen.contacts[1].first, 1);
  EXPECT_EQ(seen.contacts[2].first, 2);
  for (const ContactEvent& c : seen.contacts) EXPECT_EQ(c.time.value(), 1.5);
}

TEST(Contacts, DiscsTouchTheWallsAtTheirRim) {
  const Table table = square();
  Gas gas(table, {disc_at({0.5, 0.5}, {0, -1}, 0.125)});
  ContactRecorder seen;
  gas.world.run_until(1.0, seen);
  ASSERT_EQ(seen.hits.size(), 1u);
  EXPECT_EQ(seen.hits[0].time.value(), 0.375);
  EXPECT_EQ(seen.hits[0].position, Vector(0.5, 0.125));
  EXPECT_EQ(seen.hits[0].u, 0.5);  // of the user's wall
}

TEST(Contacts, DiscsStayInsideStadiumAnnulusAndPolygon) {
  const Table round = loop({Circle{{0, 0}, 2.0, true}});
  Table annulus = round;
  add_loop(annulus, {Circle{{0.2, 0}, 0.5, false}});
  const Table bowl = stadium();
  const Table triangle = polygon({{-2, -1}, {2, -1}, {0, 2}});
  for (const Table* table :
       std::initializer_list<const Table*>{&round, &annulus, &bowl, &triangle}) {
    Gas gas(
        *table,
        {disc_at({-0.75, 0.25}, {1, 0.5}, 0.125), disc_at({-0.75, -0.25}, {-0.3, 0.7}, 0.125),
         disc_at({-0.4, 0.7}, {0.1, -0.9}, 0.125), disc_at({-0.6, -0.6}, {0.8, 0.1}, 0.125, 2.0)});
    const double energy = gas.energy();
    ContactRecorder seen;
    gas.world.run_until(500.0, seen);
    EXPECT_GT(seen.contacts.size(), 100u);
    EXPECT_GT(seen.hits.size(), 500u);
    EXPECT_TRUE(std::none_of(seen.ends.begin(), seen.ends.end(),
                             [](const EndEvent& e) { return e.fate == Fate::lost; }));
    if (table != &triangle) {
      EXPECT_TRUE(seen.ends.empty());
    }
    if (seen.ends.empty()) {
      EXPECT_NEAR(gas.energy(), energy, 1e-12);
    }
  }
}

TEST(Contacts, ContactsAgreeWithSmallStepsInABox) {
  // The witness moves all discs in small steps and looks for the first overlap.
  const Table table = square();
  RandomStream random(9, Purpose::initial_state, 0);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<Disc> discs;
    for (const Vector x :
         {Vector{0.2, 0.2}, Vector{0.7, 0.3}, Vector{0.3, 0.8}, Vector{0.8, 0.8}, Vector{0.5, 0.5}})
      discs.push_back(disc_at(x, {random.symmetric(), random.symmetric()}, 0.0625, 1.0,
                              trial % 2 ? 1.5 * random.symmetric() : 0.0));
    Gas gas(table, discs);
    ContactRecorder seen;
    gas.world.run_until(3.0, seen);
    ASSERT_FALSE(seen.contacts.empty());
    World alone(table, discs_of(radii_of(discs)));
    const double first = seen.contacts[0].time.value();
    // Before the first contact every disc moves as if it were alone.
    std::vector<World> worlds;
    std::vector<ContactRecorder> none(discs.size());
    for (const Disc& d : discs) {
      worlds.emplace_back(table, discs_of({0.0625}));
      worlds.back().add(d.particle, d.state);
    }
    double smallest = 1.0;
    const double step = 1e-3;
    for (double t = step; t < first + step; t += step) {
      std::vector<Vector> x;
      for (std::size_t i = 0; i < discs.size(); ++i) {
        worlds[i].run_until(t, none[i]);
        x.push_back(worlds[i].state_at(0, t).position);
      }
      for (std::size_t i = 0; i < x.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
          smallest = std::min(smallest, std::sqrt(dot(x[i] - x[j], x[i] - x[j])));
      if (t < first) {
        EXPECT_GE(smallest, 0.125);
      }
    }
    EXPECT_LT(smallest, 0.125 + 2e-3);
  }
}

TEST(Contacts, NoDiscsOverlapOnATorus) {
  for (const bool oblique : {false, true}) {
    const Table table = oblique ? torus({1, 0}, {0.5, 0.9}) : torus({1, 0}, {0, 1});
    for (const int across : {2, 3, 8}) {
      std::vector<Disc> discs = square_gas(across, oblique ? 0.7 : 1.0, 0.3 / across, 7);
      // Some in a field, some heavy.
      for (std::size_t i = 0; i < discs.size(); ++i) discs[i].particle.mass = i % 3 ? 1.0 : 2.5;
      Gas gas(table, discs);
      const double energy = gas.energy();
      const Vector momentum = gas.momentum();
      ContactRecorder seen;
      for (int k = 1; k <= 40; ++k) {
        gas.world.run_until(0.25 * k, seen);
        for (int i = 0; i < gas.world.size(); ++i)
          for (int j = 0; j < i; ++j)
            for (int m = -2; m <= 2; ++m)
              for (int n = -2; n <= 2; ++n) {
                const State a = gas.world.state_at(i, 0.25 * k),
                            b = gas.world.state_at(j, 0.25 * k);
                const geometry::Cell c{a.cell.first - b.cell.first, a.cell.second - b.cell.second};
                Vector d = a.position - b.position + table.lattice->translation(c);

                d = d - table.lattice->translation({m, n});
                EXPECT_GT(std::sqrt(dot(d, d)), 0.6 / across - 1e-13);
              }
      }
      EXPECT_GT(seen.contacts.size(), 20u);
      EXPECT_TRUE(seen.ends.empty());
      EXPECT_NEAR(gas.energy() / energy, 1.0, 1e-13);
      EXPECT_NEAR(gas.momentum().x, momentum.x, 1e-13);
      EXPECT_NEAR(gas.momentum().y, momentum.y, 1e-13);
    }
  }
}

// However many turns lie between the contacts, no disc passes through another.
TEST(Contacts, DiscsThatTurnDifferentlyInAStrongFieldMeet) {
  const Table box = square(), sheet = plane(), periodic = torus({1, 0}, {0, 1});
  for (const Table* table : {&box, &sheet, &periodic}) {
    for (const double field : {30.0, 1e4, 1e6}) {
      RandomStream random(21, Purpose::initial_state, 0);
      std::vector<Disc> discs;
      const double charges[] = {1, -1, 2, 0, 0, 0.1, 0.3};
      int k = 0;
      for (const double charge : charges) {
        const Vector x{0.15 + 0.3 * (k % 3) + 0.05 * random.uniform(),
                       0.15 + 0.3 * (k / 3) + 0.05 * random.uniform()};
        const Vector centre = table == &periodic ? Vector{-0.5, -0.5} : Vector{};
        discs.push_back(disc_at(x + centre, {random.symmetric(), random.symmetric()}, 0.08, 1.0,
                                charge * field));
        ++k;
      }
      Gas gas(*table, discs);
      const double energy = gas.energy();
      ContactRecorder seen;
      for (double t = 0.125; t <= 5.0; t += 0.125) {
        gas.world.run_until(t, seen);
        for (int i = 0; i < gas.world.size(); ++i)
          for (int j = 0; j < i; ++j) {
            const State a = gas.world.state_at(i, t), b = gas.world.state_at(j, t);
            const geometry::Cell c{a.cell.first - b.cell.first, a.cell.second - b.cell.second};
            Vector d = a.position - b.position;
            if (table->lattice) {
              d = d + table->lattice->translation(c);
              d = d - Vector{std::round(d.x), std::round(d.y)};
            }
            EXPECT_GT(std::sqrt(dot(d, d)), 0.16 - 1e-12) << field;
          }
      }
      EXPECT_GT(seen.contacts.size(), table == &sheet ? 0u : 5u) << field;
      EXPECT_TRUE(std::all_of(seen.ends.begin(), seen.ends.end(), [](const EndEvent& e) {
        return e.fate != Fate::lost && e.fate != Fate::singular;
      }));
      EXPECT_NEAR(gas.energy() / energy, 1.0, 1e-12);
    }
  }
}

// The same lattice by vectors of which one is long and nearly along the other.
TEST(Contacts, DoNotDependOnTheVectorsOfALattice) {
  const Table straight = torus({1, 0}, {0, 1});
  for (const Table& table :
       {torus({1, 0}, {200, 1}), torus({1, 200}, {0, 1}), torus({1, 1}, {3, 4})}) {
    const std::vector<Disc> discs = square_gas(2, 1.0, 0.15, 7);
    Gas expected(straight, discs), gas(table, discs);
    ContactRecorder all, seen;
    expected.world.run_until(2.0, all);
    gas.world.run_until(2.0, seen);
    ASSERT_GT(all.contacts.size(), 5u);
    ASSERT_EQ(seen.contacts.size(), all.contacts.size());
    for (std::size_t i = 0; i < all.contacts.size(); ++i) {
      EXPECT_EQ(seen.contacts[i].first, all.contacts[i].first);
      EXPECT_NEAR(seen.contacts[i].time.value(), all.contacts[i].time.value(), 1e-9);
    }
  }
}

TEST(Contacts, OverlapsAreRefused) {
  const Table table = torus({1, 0}, {0, 1});
  EXPECT_THROW(Gas(table, {disc_at({-0.4, 0}, {1, 0}, 0.125), disc_at({0.4, 0.1}, {1, 0}, 0.125)}),
               std::invalid_argument);  // across the edge of the cell
  EXPECT_THROW(Gas(table, {disc_at({0, 0}, {1, 0}, 0.6)}), std::invalid_argument);
  EXPECT_NO_THROW(Gas(table, {disc_at({0, 0}, {1, 0}, 0.5)}));
  const Table box = square();
  EXPECT_THROW(Gas(box, {disc_at({0.9, 0.5}, {1, 0}, 0.125)}),
               std::invalid_argument);  // in the wall
  EXPECT_THROW(Gas(box, {disc_at({0.5, 0.5}, {1, 0}, 0.75)}), InputError);
  EXPECT_THROW(Gas(loop({Ellipse{{0, 0}, {2, 0}, 0.5, true}}), {disc_at({0, 0}, {1, 0}, 0.1)}),
               InputError);
}

}  // namespace
}  // namespace carom::tests
