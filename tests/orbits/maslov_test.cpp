// The Maslov index against the index of the action's second variation.
#include "orbits/maslov.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "carom/analyses/orbits.hpp"
#include "carom/files/system_file.hpp"

namespace carom::orbits {
namespace {

Chain chain_of(const PeriodicOrbit& orbit, std::size_t first = 0) {
  Chain chain;
  const std::size_t n = orbit.hits.size();
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t i = (first + k) % n;
    chain.push_back({orbit.hits[i].wall, orbit.hits[i].u, orbit.half_turns[i], orbit.hits[i].step});
  }
  return chain;
}

// Second derivatives of the action by the places of the hits. Half-turns follow from them by the
// closing equations, each of which has its own half-turn only.
std::vector<std::vector<double>> second_variation(const Boundary& boundary, const Chain& chain) {
  const std::vector<double> all = derivatives(boundary, geometry_of(boundary, chain));
  const std::size_t n = chain.size(), m = equations(boundary, chain);
  std::vector<std::vector<double>> h(n, std::vector<double>(n));
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      h[i][j] = all[i * m + j];
      for (std::size_t f = n; f < m; ++f)
        h[i][j] -= all[i * m + f] * all[f * m + j] / all[f * m + f];
    }
  return h;
}

// Negative eigenvalues, by Sylvester's law: as many as negative pivots.
int negative_eigenvalues(std::vector<std::vector<double>> h) {
  int count = 0;
  for (std::size_t k = 0; k < h.size(); ++k) {
    count += h[k][k] < 0.0;
    for (std::size_t i = k + 1; i < h.size(); ++i)
      for (std::size_t j = k + 1; j < h.size(); ++j) h[i][j] -= h[i][k] * h[k][j] / h[k][k];
  }
  return count;
}

// Morse's theorem: each flight beyond a half-turn meets its neighbours from the same point once.
int index_by_variation(const Boundary& boundary, const PeriodicOrbit& orbit) {
  const Chain chain = chain_of(orbit);
  const std::vector<std::vector<double>> h = second_variation(boundary, chain);
  for (std::size_t i = 0; i < h.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) EXPECT_NEAR(h[i][j], h[j][i], 1e-8 * std::abs(h[i][i]));
  const auto beyond =
      std::count_if(chain.begin(), chain.end(), [](const Link& l) { return l.half_turn > M_PI_2; });
  return 2 * static_cast<int>(chain.size()) + negative_eigenvalues(h) + static_cast<int>(beyond);
}

TEST(Maslov, IsTheIndexOfTheSecondVariation) {
  const std::string tables[] = {
      "shape = \"stadium\"\nhalf_length = 1\nradius = 1\n",
      "shape = \"ellipse\"\na = 1\nb = 0.75\n",
      "shape = \"mushroom\"\ncap_radius = 1\nstem_width = 0.5\nstem_height = 1\n",
      "shape = \"rectangle\"\nwidth = 1.3\nheight = 1\n",
      "shape = \"sinai\"\nside = 1\nradius = 0.3\n"};
  const std::string fields[] = {"", "[field]\nB = 0.4\n", "[field]\nB = -1.1\n",
                                "[field]\nB = 2\n"};
  std::set<Stability> kinds;
  int compared = 0, beyond_a_half_turn = 0;
  for (const std::string& table : tables)
    for (const std::string& field : fields) {
      const System system = read_system("[table]\n" + table + field, "maslov").system;
      const OrbitSearchResult found =
          find_orbits(system, {.most_hits = 6, .starts = 1000, .tries = 60});
      const Boundary boundary(*system.table, system.particles.front());
      for (const PeriodicOrbit& orbit : found.orbits) {
        if (!orbit.maslov) {
          EXPECT_EQ(orbit.stability, Stability::parabolic);
          continue;
        }
        EXPECT_EQ(*orbit.maslov, index_by_variation(boundary, orbit)) << table << field;
        kinds.insert(orbit.stability);
        ++compared;
        beyond_a_half_turn += std::any_of(orbit.half_turns.begin(), orbit.half_turns.end(),
                                          [](double half) { return half > M_PI_2; });
      }
    }
  EXPECT_EQ(kinds.size(), 3U);
  EXPECT_GT(compared, 300);
  EXPECT_GT(beyond_a_half_turn, 20);
}

TEST(Maslov, DoesNotDependOnWhereThePeriodBegins) {
  const System system =
      read_system("[table]\nshape = \"stadium\"\nhalf_length = 1\nradius = 1\n[field]\nB = 0.5\n",
                  "maslov")
          .system;
  const Boundary boundary(*system.table, system.particles.front());
  for (const PeriodicOrbit& orbit :
       find_orbits(system, {.most_hits = 6, .starts = 1000, .tries = 60}).orbits)
    for (std::size_t first = 0; first < orbit.hits.size(); ++first) {
      const Chain chain = chain_of(orbit, first);
      EXPECT_EQ(maslov_index(flights_across(boundary, chain, geometry_of(boundary, chain)),
                             orbit.stability),
                orbit.maslov);
    }
}

// Walls that disperse focus nothing: 2 from each reflection.
TEST(Maslov, IsTwoAHitAmongDiscs) {
  const System system = load_system("three-disc").system;
  for (const PeriodicOrbit& orbit : find_orbits(system, {.most_hits = 7}).orbits)
    EXPECT_EQ(orbit.maslov, 2 * static_cast<int>(orbit.hits.size()));
}

// A resonator of two mirrors, stable: exp(i pi/2) and two reflections (a Gaussian beam's phase).
// In the ellipse the short axis is one, the long axis is beyond its focus twice.
TEST(Maslov, OfTheAxesOfAnEllipse) {
  const System system =
      read_system("[table]\nshape = \"ellipse\"\na = 1\nb = 0.75\n", "maslov").system;
  const OrbitSearchResult found = find_orbits(system, {.most_hits = 2, .starts = 500});
  const PeriodicOrbit *stable = nullptr, *unstable = nullptr;
  for (const PeriodicOrbit& orbit : found.orbits)
    (orbit.stability == Stability::elliptic ? stable : unstable) = &orbit;
  ASSERT_TRUE(stable && unstable);
  EXPECT_EQ(stable->maslov, 5);
  EXPECT_EQ(unstable->maslov, 6);
}

}  // namespace
}  // namespace carom::orbits
