// Steps beside Bézier curves: their graphs, and orbits against flights, conics and their reversal.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "carom/base/random.hpp"
#include "carom/files/system_file.hpp"
#include "carom/table/make.hpp"
#include "events/step/curve_graph.hpp"
#include "forces/quad.hpp"
#include "recorder.hpp"

namespace carom::tests {
namespace {

using events::CurveGraph;
using events::CurvePart;
using events::FramedGraph;
using forces::Quad;
using geometry::Bezier;

Bezier random_curve(RandomStream& random) {
  const auto number = [&] { return random.uniform() - 0.5; };
  Bezier curve;
  curve.degree = 2 + static_cast<int>(4.0 * random.uniform());
  curve.from = {number(), number()};
  curve.to = {number() + 3.0, number()};
  for (int k = 1; k < curve.degree; ++k)
    curve.inner[static_cast<std::size_t>(k - 1)] = {number() + 3.0 * k / curve.degree,
                                                    2.0 * number()};
  return curve;
}

TEST(CurveGraph, PartsAreTheCurveToRounding) {
  RandomStream random(11, Purpose::initial_state, 0);
  std::size_t parts = 0;
  for (int n = 0; n < 200; ++n) {
    Bezier curve = random_curve(random);
    if (n % 4 == 0) curve.inner[0] = curve.from;  // rests at its start
    double end = 0.0;
    for (const CurvePart& part : events::parts_of(curve)) {
      EXPECT_EQ(part.from, end);
      end = part.to;
      ++parts;
      const FramedGraph<double> in_doubles(curve, part);
      const FramedGraph<Quad> exact(curve, part);
      const CurveGraph<double>& graph = in_doubles.graph;
      if (part.straight) continue;
      EXPECT_TRUE(in_doubles.is_short());
      for (int k = 0; k < 20; ++k) {
        const double s = (0.05 * k + 0.02) * graph.length();
        const auto here = graph.at(s);
        const auto there = exact.graph.at(Quad(s));
        const double bound = 0x1p-53 * CurveGraph<double>::roundings() * graph.extent;
        EXPECT_LE(std::fabs(here.y - there.y.to_double()), bound);
        EXPECT_LE(graph.lowest - bound, here.y);
        EXPECT_LE(here.y, graph.highest + bound);
        EXPECT_LE(std::fabs(here.slope), graph.slope);
        EXPECT_LE(std::fabs(there.bend.to_double()), exact.graph.bend.to_double());
        const double step = 0.01 * graph.length();
        if (!(s + step < graph.length())) continue;
        const double next = exact.graph.at(Quad(s + step)).bend.to_double();
        EXPECT_LE(std::fabs(next - there.bend.to_double()),
                  exact.graph.turn.to_double() * step * (1.0 + 1e-9));
      }
    }
    EXPECT_EQ(end, 1.0);
  }
  EXPECT_LT(parts, 200u * 40u);
}

/// Runs a system to its t_max, which all survive.
struct Orbit {
  Recorder seen;
  State end;
  double energy_error = 0.0;
};
Orbit run_of(const std::string& table, const std::string& more, Vector position, Vector velocity,
             double t) {
  const LoadedSystem loaded = read_system(table + more, "curves");
  Dynamics dynamics = loaded.system.dynamics;
  dynamics.everywhere = true;
  World world(*loaded.system.table, dynamics);
  world.watch_energy();
  Orbit run;
  world.add(loaded.system.particles.front(), start(position, velocity));
  world.run_until(t, run.seen);
  EXPECT_EQ(world.fate(0), Fate::survived) << world.report(0) << table;
  run.end = world.state_at(0, Time(t));
  EXPECT_TRUE(world.contains(run.end.position));
  run.energy_error = world.energy_balance(0).largest / world.energy_balance(0).kinetic;
  return run;
}
const std::string well =
    "[[potential]]\nkind = \"harmonic\"\nomega = 1\ncenter = [0.1, 0.05]\n[particles]\nspeed = 1\n"
    "[integrator]\nscheme = \"blanes-moan-srkn11b\"\nstep = 0.02\n";
std::string polar(const std::string& radius) {
  return "[table]\nshape = \"polar\"\nradius = \"" + radius + "\"\n";
}

TEST(CurvesInSteps, ConicsWrittenAsCurvesHaveTheirOrbits) {
  const std::string circle = "[table]\nshape = \"circle\"\nradius = 1\n",
                    ellipse = "[table]\nshape = \"ellipse\"\na = 2\nb = 1\n",
                    as_curve =
                        "[table]\nshape = \"parametric\"\nx = \"2*cos(t)\"\ny = \"sin(t)\"\n";
  for (const auto& [conic, curve] :
       {std::pair{circle, polar("1 + 0*phi")}, std::pair{ellipse, as_curve}}) {
    const Orbit a = run_of(conic, well, {0.3, 0.1}, {0.9, 1.2}, 20.0),
                b = run_of(curve, well, {0.3, 0.1}, {0.9, 1.2}, 20.0);
    ASSERT_EQ(a.seen.hits.size(), b.seen.hits.size());
    ASSERT_GT(a.seen.hits.size(), 8u);
    for (std::size_t i = 0; i < a.seen.hits.size(); ++i) {
      const Vector d = a.seen.hits[i].position - b.seen.hits[i].position;
      EXPECT_LT(length(d), 1e-12 * std::pow(3.0, static_cast<double>(i))) << i;
    }
  }
}

const char* const shapes[] = {"shape = \"limacon\"\nradius = 1\nepsilon = 0.5\n",
                              "shape = \"cardioid\"\nradius = 1\n",
                              "shape = \"superellipse\"\na = 1\nb = 0.8\nexponent = 4\n",
                              ("shape = \"spline\"\npoints = [[-1, -1], [0, -0.6], [1.2, -0.8], "
                               "[1, 1], [-0.2, 0.6], [-1, 1]]\n")};

TEST(CurvesInSteps, WithoutForcesOrbitsAreFlights) {
  for (const std::string shape : shapes) {
    const LoadedSystem loaded =
        read_system("[table]\n" + shape + "[particles]\nspeed = 1\n", "curves");
    Recorder flights;
    World free(*loaded.system.table);
    free.add(particle(), start({0.4, 0.1}, {0.6, 0.8}));
    free.run_until(12.0, flights);
    const Orbit steps =
        run_of("[table]\n" + shape, "[particles]\nspeed = 1\n[integrator]\nstep = 0.07\n",
               {0.4, 0.1}, {0.6, 0.8}, 12.0);
    ASSERT_EQ(flights.hits.size(), steps.seen.hits.size()) << shape;
    ASSERT_GT(flights.hits.size(), 4u);
    for (std::size_t i = 0; i < flights.hits.size(); ++i) {
      EXPECT_EQ(flights.hits[i].wall, steps.seen.hits[i].wall) << shape << i;
      EXPECT_LT(length(flights.hits[i].position - steps.seen.hits[i].position),
                1e-14 * std::pow(6.0, static_cast<double>(i)))
          << shape << i;
    }
  }
}

TEST(CurvesInSteps, ReversedOrbitsReturnAndEnergyHolds) {
  for (const std::string shape : shapes) {
    const Vector from{0.4, 0.2};
    const Orbit there = run_of("[table]\n" + shape, well, from, {1.2, 1.6}, 6.0);
    EXPECT_GT(there.seen.hits.size(), 3u) << shape;
    EXPECT_LT(there.energy_error, 1e-9) << shape;
    const Orbit back =
        run_of("[table]\n" + shape, well, there.end.position, -there.end.velocity, 6.0);
    EXPECT_LT(length(back.end.position - from), 1e-8) << shape;
  }
}

// Aimed at the tip of a cusp, straight and a little beside it, with a step that meets all parts.
TEST(CurvesInSteps, CuspsLeakNothing) {
  const LoadedSystem loaded =
      read_system("[table]\nshape = \"cardioid\"\nradius = 1\n" + well, "curves");
  World world(*loaded.system.table, loaded.system.dynamics);
  int hits = 0;
  for (int n = 0; n <= 60; ++n)
    for (const double side : {1.0, -1.0}) {
      const double beside = n == 60 ? 0.0 : side * std::ldexp(1.0, -n);
      const Vector from{0.5, beside + 0.25};
      const Vector aimed = Vector{0.0, beside} - from;
      world.clear();
      world.add(loaded.system.particles.front(), start(from, (1.0 / length(aimed)) * aimed));
      Recorder seen;
      world.run_until(1.5, seen);
      EXPECT_NE(world.fate(0), Fate::lost) << beside;
      EXPECT_NE(world.fate(0), Fate::unresolved) << beside << world.report(0);
      hits += static_cast<int>(seen.hits.size());
    }
  EXPECT_GT(hits, 60);
}

}  // namespace
}  // namespace carom::tests
