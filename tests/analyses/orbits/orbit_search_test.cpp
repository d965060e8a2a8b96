// Periodic orbits against closed forms and published values (shared with validation/cases).
#include "carom/analyses/orbits.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "analyses/systems.hpp"
#include "carom/base/error.hpp"
#include "carom/files/system_file.hpp"

namespace carom {
namespace {

OrbitSearchResult found(const System& system, OrbitSearchOptions options) {
  OrbitSearchResult result = find_orbits(system, options);
  EXPECT_TRUE(result.complete);
  return result;
}

const PeriodicOrbit* near_length(const OrbitSearchResult& result, std::size_t hits, double length) {
  for (const PeriodicOrbit& orbit : result.orbits)
    if (orbit.hits.size() == hits && std::abs(orbit.length - length) < 1e-9) return &orbit;
  return nullptr;
}

struct Published {
  std::size_t hits;
  double period, multiplier;
};

TEST(OrbitSearch, FindsTheOrbitsOfThreeDiscs) {
  const System system = load_system("three-disc").system;
  const OrbitSearchResult result = found(system, {.most_hits = 6});
  EXPECT_EQ(result.symmetries, 6U);
  EXPECT_EQ(result.shadowed, 0U);
  EXPECT_EQ(result.unsolved, 0U);
  // Every cyclic word of the discs belongs to one orbit, and each orbit to its copies.
  std::map<std::size_t, int> words;
  for (const PeriodicOrbit& orbit : result.orbits) {
    words[orbit.hits.size()] += orbit.copies;
    EXPECT_EQ(orbit.stability == Stability::hyperbolic, orbit.hits.size() % 2 == 0);
  }
  EXPECT_EQ(words, (std::map<std::size_t, int>{{2, 3}, {3, 2}, {4, 3}, {5, 6}, {6, 9}}));
  // What the symmetry leaves of them: 0, 1, 01, 001, 011 (Gaspard & Rice; REFERENCE values).
  const Published published[] = {{1, 4.0, 9.898979485566356},
                                 {1, 6.0 - std::sqrt(3.0), -11.77145519638556},
                                 {2, 8.316529485168301740, -124.0948019921975},
                                 {3, 12.32174661618262242, -1240.542557041512},
                                 {3, 12.58080774103251844, 1449.545074956036}};
  const OrbitSearchResult longer = found(system, {.most_hits = 9});
  for (const Published& p : published) {
    bool seen = false;
    for (const PeriodicOrbit& orbit : longer.orbits)
      seen = seen ||
             (orbit.hits.size() == p.hits * static_cast<std::size_t>(orbit.reduced.order) &&
              std::abs(orbit.reduced.period - p.period) < 1e-12 * p.period &&
              std::abs(orbit.reduced.multiplier - p.multiplier) < 1e-12 * std::abs(p.multiplier));
    EXPECT_TRUE(seen) << p.period;
  }
}

// From the top of a disc to that of the next one: chord a, curvature k = B, tangent to the lattice
// vector.
TEST(OrbitSearch, FindsRunawayOrbitsOfOneHit) {
  const double a = 1.0, k = 1.0, r = 0.4, alpha = std::asin(0.5 * k * a);
  const OrbitSearchResult result = found(make_system(R"(
[table]
shape = "lorentz"
lattice = "square"
spacing = 1
radius = 0.4
[field]
B = 1
)"),
                                         {.most_hits = 2, .starts = 2000, .tries = 50});
  const PeriodicOrbit* orbit = near_length(result, 1, 2.0 * alpha / k);
  ASSERT_TRUE(orbit);
  EXPECT_EQ(std::abs(orbit->shift.first) + std::abs(orbit->shift.second), 1);
  EXPECT_EQ(orbit->copies, 4);
  EXPECT_NEAR(
      orbit->trace,
      -2.0 * std::cos(2.0 * alpha) - 4.0 * std::cos(alpha) / k * (1.0 / r - k * std::cos(alpha)),
      orbit->trace_error);
}

TEST(OrbitSearch, TracesOfTwoBounceOrbitsHaveAClosedForm) {
  const OrbitSearchResult stadium = found(make_system(R"(
[table]
shape = "stadium"
half_length = 1
radius = 1
)"),
                                          {.most_hits = 4, .starts = 4000, .tries = 300});
  const PeriodicOrbit* axis = near_length(stadium, 2, 8.0);
  ASSERT_TRUE(axis);
  EXPECT_NEAR(axis->trace, 34.0, 1e-12);
  EXPECT_NEAR(axis->multipliers[0].real(), 17.0 + 12.0 * std::sqrt(2.0), 1e-12);
  const PeriodicOrbit* balls = near_length(stadium, 2, 4.0);
  ASSERT_TRUE(balls);
  EXPECT_TRUE(balls->family);
  EXPECT_EQ(balls->stability, Stability::parabolic);
  EXPECT_NEAR(balls->trace, 2.0, 1e-12);

  const OrbitSearchResult ellipse = found(make_system(R"(
[table]
shape = "ellipse"
a = 1
b = "3/4"
)"),
                                          {.most_hits = 3, .starts = 4000, .tries = 300});
  const PeriodicOrbit *major = near_length(ellipse, 2, 4.0), *minor = near_length(ellipse, 2, 3.0);
  ASSERT_TRUE(major && minor);
  EXPECT_NEAR(major->trace, 24.12345679012, 1e-11);
  EXPECT_EQ(major->stability, Stability::hyperbolic);
  EXPECT_NEAR(minor->trace, -1.9375, 1e-12);
  EXPECT_EQ(minor->stability, Stability::elliptic);
  EXPECT_NEAR(std::abs(minor->multipliers[0]), 1.0, 1e-14);
  // Poncelet: all triangles have one length.
  int triangles = 0;
  for (const PeriodicOrbit& orbit : ellipse.orbits) triangles += orbit.hits.size() == 3;
  EXPECT_EQ(triangles, 1);
}

// Pieces err by more than rounding, so the rank is lost within the pieces' errors.
TEST(OrbitSearch, FamiliesOnACurveOfFormulasAreThoseOfTheEllipse) {
  const OrbitSearchOptions options{.most_hits = 3, .starts = 300, .tries = 20};
  for (const std::string field : {"", "[field]\nB = 0.4\n"}) {
    const auto found_in = [&](const std::string& table) {
      return found(make_system("[table]\nshape = " + table + field), options);
    };
    const OrbitSearchResult own = found_in("'ellipse'\na = 1\nb = 0.75\n"),
                            curve = found_in("'parametric'\nx = 'cos(t)'\ny = '0.75*sin(t)'\n");
    for (const PeriodicOrbit& orbit : own.orbits) {
      const PeriodicOrbit* same = near_length(curve, orbit.hits.size(), orbit.length);
      ASSERT_TRUE(same) << orbit.hits.size() << " " << orbit.length;
      EXPECT_EQ(same->family, orbit.family);
      EXPECT_EQ(same->stability, orbit.stability);
      EXPECT_NEAR(same->trace, orbit.trace, same->trace_error + orbit.trace_error);
    }
    EXPECT_EQ(curve.orbits.size(), own.orbits.size());
  }
}

TEST(OrbitSearch, GivesTheSameOnAnyNumberOfThreads) {
  const System system = load_system("magnetic-square").system;
  const OrbitSearchResult one =
      found(system, {.most_hits = 4, .starts = 2000, .tries = 200, .threads = 1});
  const OrbitSearchResult three =
      found(system, {.most_hits = 4, .starts = 2000, .tries = 200, .threads = 3});
  ASSERT_EQ(one.orbits.size(), three.orbits.size());
  EXPECT_FALSE(one.orbits.empty());
  for (std::size_t i = 0; i < one.orbits.size(); ++i) {
    EXPECT_EQ(one.orbits[i].length, three.orbits[i].length);
    EXPECT_EQ(one.orbits[i].trace, three.orbits[i].trace);
  }
}

TEST(OrbitSearch, RefusesWhatHasNoOrbits) {
  const auto place = [](const System& system) {
    try {
      find_orbits(system);
    } catch (const InputError& error) {
      return error.place().key;
    }
    return std::string("no error");
  };
  EXPECT_EQ(place(load_system("henon-heiles").system), "table");
  EXPECT_EQ(place(load_system("coulomb-circle").system), "particles.count");
  EXPECT_EQ(place(load_system("soft-lorentz").system), "table");
  System two = load_system("stadium").system;
  two.particles.push_back(two.particles.front());
  EXPECT_EQ(place(two), "particles.count");
}

}  // namespace
}  // namespace carom
