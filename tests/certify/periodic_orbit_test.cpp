// Periodic orbits that are proven, with their digits.
#include "carom/certify/certified_periodic_orbit.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "carom/analyses/orbits.hpp"
#include "carom/files/system_file.hpp"
#include "certify/flight/beside_curve.hpp"

namespace carom {
namespace {

std::vector<NearHit> near(const PeriodicOrbit& orbit) {
  std::vector<NearHit> hits;
  for (std::size_t i = 0; i < orbit.hits.size(); ++i)
    hits.push_back({orbit.hits[i].wall, orbit.hits[i].position, orbit.hits[i].u,
                    orbit.half_turns[i], orbit.hits[i].step});
  return hits;
}

const char* const systems[] = {
    ("[table]\nshape = \"discs\"\ncenters = [[0, 0], [6, 0], [3, \"3*sqrt(3)\"]]\nradius = 1\n"
     "[initial]\nkind = \"boundary\"\n"),
    "[table]\nshape = \"stadium\"\nhalf_length = 1\nradius = 1\n",
    "[table]\nshape = \"ellipse\"\na = 1\nb = \"3/4\"\n[field]\nlarmor_radius = 3\n",
    "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n[field]\nlarmor_radius = 0.5075\n",
    "[table]\nshape = \"sinai\"\nside = 1\nradius = 0.4\n[field]\nB = -0.7\n",
    "[table]\nshape = \"limacon\"\nradius = 1\nepsilon = 0.3\n",
    "[table]\nshape = \"parametric\"\nx = \"1.5*sin(t) + 0.1\"\ny = \"cos(t) + 0.2*cos(2*t)\"\n",
    "[table]\nshape = \"robnik\"\nradius = 1\nlambda = 0.2\n[field]\nB = 0.3\n",
    "[table]\nshape = \"flower\"\nradius = 1\nepsilon = 0.1\npetals = 3\n[field]\nB = -0.4\n",
    "[table]\nshape = \"implicit\"\nequation = \"x^4 + y^2 + 0.2*x - 1\"\ninside = [0.1, 0.13]\n",
    "[table]\nshape = \"spline\"\npoints = [[-1, -1], [1, -1.2], [1.4, 0.3], [0.1, 0.9]]\n",
    "[table]\nshape = \"path\"\nloop = [{start = [-1, -1], pieces = [{bezier = [[0, -1.5], [1, "
    "-1]]}, {arc_via = [1.5, 0], arc_to = [1, 1]}, {line_to = [-1, 1.2]}, {line_to = [-1, -1]}]}]"
    "\n[[table.obstacle]]\nshape = \"circle\"\ncenter = [0.1, 0.1]\nradius = 0.4\n"};

// Two ways to the same numbers: doubles with the tangent maps of flights and reflections, and balls
// with the closed form across the orbit.
TEST(CertifiedPeriodicOrbit, ProvesWhatDoublesFind) {
  for (const char* toml : systems) {
    const LoadedSystem loaded = read_system(toml, "test");
    const OrbitSearchResult found =
        find_orbits(loaded.system, {.most_hits = 4, .starts = 1000, .tries = 40});
    int proven = 0;
    for (const PeriodicOrbit& orbit : found.orbits) {
      const CertifiedPeriodicOrbit certified = certify_orbit(loaded.exact, near(orbit), 30);
      EXPECT_NE(certified.proven, orbit.family) << toml << certified.reason;
      if (!certified.proven) continue;
      ++proven;
      EXPECT_LT(certified.length.log2_error(), -99.0);
      EXPECT_NEAR(certified.length.to_double(), orbit.length, orbit.length_error);
      EXPECT_NEAR(certified.trace.to_double(), orbit.trace, orbit.trace_error);
      for (std::size_t i = 0; i < orbit.hits.size(); ++i) {
        EXPECT_NEAR(certified.x[i].to_double(), orbit.hits[i].position.x, 2 * orbit.position_error);
        EXPECT_NEAR(certified.y[i].to_double(), orbit.hits[i].position.y, 2 * orbit.position_error);
      }
      EXPECT_EQ(certified.multiplier.has_value(), orbit.stability != Stability::elliptic);
    }
    EXPECT_GT(proven, 1) << toml;
  }
}

TEST(CertifiedPeriodicOrbit, HasTheDigitsOfClosedForms) {
  const LoadedSystem discs = read_system(systems[0], "test");
  const OrbitSearchResult found = find_orbits(discs.system, {.most_hits = 3});
  ASSERT_EQ(found.orbits.size(), 2U);
  const CertifiedPeriodicOrbit pair = certify_orbit(discs.exact, near(found.orbits[0]), 50);
  ASSERT_TRUE(pair.proven) << pair.reason;
  // Lambda of a flight is 5 + sqrt(24), of two its square, 49 + 20 sqrt(6).
  EXPECT_EQ(pair.multiplier.text(50), "97.98979485566356196394568149411782783931894961313340");
  const CertifiedPeriodicOrbit triangle = certify_orbit(discs.exact, near(found.orbits[1]), 30);
  ASSERT_TRUE(triangle.proven) << triangle.reason;
  // 18 - 3 sqrt(3).
  EXPECT_EQ(triangle.period.text(30), "12.803847577293368119417660975482");
}

TEST(CertifiedPeriodicOrbit, FollowsTheCurveAsItIsWritten) {
  const LoadedSystem cardioid = read_system("[table]\nshape = \"cardioid\"\nradius = 1\n", "test");
  const OrbitSearchResult found =
      find_orbits(cardioid.system, {.most_hits = 4, .starts = 2000, .tries = 100});
  ASSERT_EQ(found.orbits.size(), 4U);
  const CertifiedPeriodicOrbit first = certify_orbit(cardioid.exact, near(found.orbits[0]), 50),
                               last = certify_orbit(cardioid.exact, near(found.orbits[3]), 50);
  // 3 sqrt(3) and 16 / sqrt(3): closer than the pieces are to the curve.
  EXPECT_EQ(first.length.text(50), "5.19615242270663188058233902451761710082841576143114");
  EXPECT_EQ(first.multiplier.text(30), "4.000000000000000000000000000000");
  EXPECT_EQ(last.length.text(50), "9.23760430703401223214638048803131929036162802032203");
}

TEST(CertifiedPeriodicOrbit, SeesTheCurveInTheWay) {
  TableSpec spec;
  spec.shape = "flower";
  spec.numbers = {
      {"radius", ExactNumber("1")}, {"epsilon", ExactNumber("0.8")}, {"petals", ExactNumber("2")}};
  const certify::Precision precision(128);
  const certify::Pieces pieces(spec, table::shapes::written_shape(spec));
  const auto is_free = [&](double from, double to) {
    const certify::Ball s(from), t(to);
    const certify::BallVector P = pieces[0].at(s).point, Q = pieces[0].at(t).point;
    return certify::meets_nowhere_else(pieces, {P, Q, Q - P, certify::Ball(0)},
                                       certify::Pieces::Spot{0, s}, certify::Pieces::Spot{0, t});
  };
  EXPECT_TRUE(is_free(0.25, -0.25));
  EXPECT_TRUE(is_free(0.25, 3.25));
  EXPECT_FALSE(is_free(0.25, 2.75));  // over the waist
  EXPECT_FALSE(is_free(0.5, 2.0));
}

TEST(CertifiedPeriodicOrbit, RefusesWhatIsNone) {
  const LoadedSystem loaded = read_system(systems[0], "test");
  // Three discs in a row: the middle one stands in the way.
  const LoadedSystem row = read_system(
      "[table]\nshape = \"discs\"\ncenters = [[0, 0], [6, 0], [3, 0]]\nradius = 1\n[initial]\nkind "
      "= \"boundary\"\n",
      "test");
  const std::vector<NearHit> hits{{0, {1.0, 0.0}, 0.0, 0.0, {}}, {1, {5.0, 0.0}, 2.0, 0.0, {}}};
  EXPECT_TRUE(certify_orbit(loaded.exact, hits, 20).proven);
  const CertifiedPeriodicOrbit none = certify_orbit(row.exact, hits, 20);
  EXPECT_FALSE(none.proven);
  EXPECT_NE(none.reason, "");
}

}  // namespace
}  // namespace carom
