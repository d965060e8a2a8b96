#include "carom/analyses/diffusion.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "analyses/systems.hpp"
#include "carom/base/error.hpp"
#include "carom/events/world.hpp"
#include "carom/starts/sampler.hpp"

namespace carom {
namespace {

constexpr double pi = 3.141592653589793;

System lorentz(const char* lattice, double spacing, double radius, double t_max,
               std::uint64_t trajectories, const std::string& more = {}) {
  System system = make_system("[table]\nshape = \"lorentz\"\nlattice = \"" + std::string(lattice) +
                              "\"\nspacing = " + std::to_string(spacing) +
                              "\nradius = " + std::to_string(radius) +
                              "\n[run]\nt_max = " + std::to_string(t_max) + "\n" + more);
  system.run.trajectories = trajectories;
  return system;
}

void expect_equal(const DiffusionResult& a, const DiffusionResult& b) {
  EXPECT_EQ(a.digest, b.digest);
  EXPECT_EQ(a.collisions, b.collisions);
  const auto p = DisplacementMoments(a.sums).points(), q = DisplacementMoments(b.sums).points();
  for (std::size_t k = 0; k < p.size(); ++k) {
    EXPECT_EQ(p[k].square.value, q[k].square.value);
    EXPECT_EQ(p[k].square.error, q[k].square.error);
    EXPECT_EQ(p[k].fourth.error, q[k].fourth.error);
    EXPECT_EQ(p[k].correlation.value, q[k].correlation.value);
    EXPECT_EQ(p[k].correlation.error, q[k].correlation.error);
    EXPECT_EQ(p[k].green_kubo.value, q[k].green_kubo.value);
    EXPECT_EQ(p[k].green_kubo.error, q[k].green_kubo.error);
  }
}

TEST(Diffusion, DoesNotDependOnThreadsOrBlocks) {
  const System system = lorentz("triangular", 2.2, 1, 30, 400);
  DiffusionOptions options;
  options.threads = 1;
  const DiffusionResult one = run_diffusion(system, options);
  EXPECT_EQ(one.survived, 400u);
  for (const int threads : {2, 3}) {
    for (const std::uint64_t block : {1u, 7u, 100000u}) {
      options.threads = threads;
      options.block = block;
      expect_equal(run_diffusion(system, options), one);
    }
  }
}

// The displacement as the sum of all flights, which knows nothing of cells.
class Flights : public Observer {
 public:
  void hit(const HitEvent& event) override {
    sum = sum + event.flight_time * event.before;
    last = event.time;
    velocity = event.after;
  }
  geometry::Vector sum, velocity;
  Time last;
};

TEST(Diffusion, IsTheSumOfTheFlights) {
  System system = lorentz("square", 1, 0.3, 200, 20);
  system.run.times = {200};
  const DiffusionResult result = run_diffusion(system);
  const Sampler sampler(system);
  double sum = 0, along = 0, correlation = 0;
  for (std::uint64_t trajectory = 0; trajectory < 20; ++trajectory) {
    World world(*system.table);
    Flights flights;
    add_start(world, sampler, trajectory, 0);
    const geometry::Vector first = flights.velocity = world.state(0).velocity;
    world.run_until(200, flights);
    const geometry::Vector all = flights.sum + (Time(200) - flights.last) * flights.velocity;
    sum += dot(all, all);
    along += dot(first, all);
    correlation += dot(first, flights.velocity);
  }
  const MomentPoint point = DisplacementMoments(result.sums).points().back();
  EXPECT_NEAR(point.square.value, sum / 20, 1e-10 * sum);
  EXPECT_NEAR(point.green_kubo.value, along / 40, 1e-10);
  EXPECT_NEAR(point.correlation.value, correlation / 20, 1e-12);
}

TEST(Diffusion, StartsBallistic) {
  System system = lorentz("triangular", 2.2, 1, 1, 2000);
  system.run.times = {0, 1e-6};
  const auto points = DisplacementMoments(run_diffusion(system).sums).points();
  EXPECT_EQ(points[0].square.value, 0.0);
  EXPECT_NEAR(points[1].square.value, 1e-12, 1e-15);
}

// An independent simulation: D = .1699(3) for gap .2 in units of the disc's radius; Machta and
// Zwanzig only as w -> 0.
TEST(Diffusion, TriangularGasHasItsCoefficient) {
  const System system = lorentz("triangular", 2.2, 1, 100, 30000);
  const DiffusionResult result = run_diffusion(system);
  EXPECT_EQ(result.lost, 0u);
  const DisplacementMoments moments(result.sums);
  const auto fit = moments.fit(moments.default_window());
  ASSERT_TRUE(fit);
  EXPECT_LT(fit->D.error, 0.002);
  EXPECT_NEAR(fit->D.value, 0.1699, 3 * std::hypot(fit->D.error, 0.0003));
  EXPECT_NEAR(fit->exponent.value, 1.0, 3 * fit->exponent.error);
  const Horizon horizon = horizon_of(system);
  EXPECT_EQ(horizon.kind, Horizon::Kind::finite);
  EXPECT_NEAR(horizon.machta_zwanzig.value(), 0.2 * 4.84 / (pi * (std::sqrt(3.0) * 4.84 - 2 * pi)),
              1e-12);
}

TEST(Diffusion, ScalesWithRadiusAndSpeed) {
  const System unit = lorentz("triangular", 2.2, 1, 32, 200);
  System scaled = lorentz("triangular", 8.8, 4, 64, 200, "[particles]\nspeed = 2\n");
  scaled.run.times = unit.run.times;
  for (double& t : scaled.run.times) t *= 2;
  const auto a = DisplacementMoments(run_diffusion(unit).sums).points();
  const auto b = DisplacementMoments(run_diffusion(scaled).sums).points();
  // Powers of two: until chaos shows the last bits, the same orbits.
  for (std::size_t k = 0; k + 14 < a.size(); ++k)
    EXPECT_NEAR(b[k].square.value, 16 * a[k].square.value, 1e-9);
  EXPECT_NEAR(*horizon_of(scaled).machta_zwanzig, 8 * *horizon_of(unit).machta_zwanzig, 1e-12);
}

// t P(no hit until t) tends to what the corridors say.
TEST(Horizon, CorridorsAreTheTailOfFreeFlights) {
  for (const char* lattice : {"square", "triangular"}) {
    System system = lorentz(lattice, 1, 0.4, 40, 600'000);
    const Horizon horizon = horizon_of(system);
    ASSERT_EQ(horizon.kind, Horizon::Kind::infinite);
    if (std::string(lattice) == "square") {
      EXPECT_NEAR(horizon.flight_tail, 2 * 0.04 / (pi * (1 - pi * 0.16)), 1e-14);
    }
    EXPECT_NE(no_diffusion(horizon), "");
    const Sampler sampler(system);
    World world(*system.table);
    world.limit_hits(1);
    Observer nothing;
    double free = 0;
    for (std::uint64_t trajectory = 0; trajectory < system.run.trajectories; ++trajectory) {
      world.clear();
      add_start(world, sampler, trajectory, 0);
      world.run_until(40, nothing);
      free += world.hits(0) == 0;
    }
    const double share = free / static_cast<double>(system.run.trajectories);
    // The limit is reached as 1/t: by less than 2 % at t = 40.
    EXPECT_NEAR(40 * share, horizon.flight_tail, horizon.flight_tail * (4 / std::sqrt(free) + 0.02))
        << lattice;
  }
}

// Corridors of points are too narrow for discs: a disc among discs is a point among larger ones.
TEST(Horizon, ADiscHasTheHorizonOfItsCentre) {
  const char* disc = "[interaction]\nkind = \"hard-discs\"\nradius = 0.05\n";
  ASSERT_EQ(horizon_of(lorentz("triangular", 2.4, 1, 1, 1)).kind, Horizon::Kind::infinite);
  const Horizon point = horizon_of(lorentz("triangular", 2.4, 1.05, 1, 1));
  const Horizon one = horizon_of(lorentz("triangular", 2.4, 1, 1, 1, disc));
  EXPECT_EQ(one.kind, Horizon::Kind::finite);
  EXPECT_EQ(one.corridors.list.size(), 0u);
  EXPECT_EQ(one.machta_zwanzig.value(), point.machta_zwanzig.value());
  const Horizon wide = horizon_of(lorentz("square", 1, 0.35, 1, 1, disc));
  EXPECT_EQ(wide.kind, Horizon::Kind::infinite);
  EXPECT_NEAR(wide.flight_tail, 2 * 0.04 / (pi * (1 - pi * 0.16)), 1e-14);
  for (const char* radii : {"radius = 0.05\n", "radius = 0.001\n"}) {
    const Horizon two = horizon_of(lorentz(
        "triangular", 2.4, 1, 1, 1,
        std::string("[particles]\ncount = 2\n[interaction]\nkind = \"hard-discs\"\n") + radii));
    EXPECT_EQ(two.kind, Horizon::Kind::unknown);
    EXPECT_FALSE(two.machta_zwanzig);
    EXPECT_EQ(two.flight_tail, 0);
    EXPECT_TRUE(two.corridors.list.empty());
  }
}

TEST(Horizon, FieldsAndWallsDecide) {
  EXPECT_EQ(horizon_of(lorentz("triangular", 2.4, 1, 1, 1)).kind, Horizon::Kind::infinite);
  const Horizon bent = horizon_of(lorentz("triangular", 2.4, 1, 1, 1, "[field]\nB = 0.1\n"));
  EXPECT_EQ(bent.kind, Horizon::Kind::finite);
  EXPECT_EQ(bent.corridors.list.size(), 3u);
  EXPECT_FALSE(bent.machta_zwanzig);
  EXPECT_EQ(no_diffusion(bent), "");
  EXPECT_EQ(horizon_of(make_system(magnetic_square)).kind, Horizon::Kind::bounded);
  EXPECT_FALSE(horizon_of(lorentz("square", 1, 0.5, 1, 1)).machta_zwanzig);
}

TEST(Diffusion, TheSignOfTheFieldDoesNotMatter) {
  DisplacementMoments forward(
      run_diffusion(lorentz("triangular", 2.4, 1, 50, 6000, "[field]\nB = 0.5\n")).sums);
  DisplacementMoments backward(
      run_diffusion(lorentz("triangular", 2.4, 1, 50, 6000, "[field]\nB = -0.5\n")).sums);
  const auto a = forward.fit({5, 50}), b = backward.fit({5, 50});
  EXPECT_NEAR(a->D.value, b->D.value, 4 * std::hypot(a->D.error, b->D.error));
  EXPECT_GT(a->D.value, 10 * a->D.error);
}

TEST(Diffusion, StopsWithWholeTrajectories) {
  System system = lorentz("triangular", 2.2, 1, 10, 1'000'000);
  std::atomic<bool> stop{false};
  DiffusionOptions options;
  options.threads = 2;
  options.interrupted = &stop;
  options.progress = [&](std::uint64_t done, std::uint64_t) { stop = stop || done > 200; };
  const DiffusionResult result = run_diffusion(system, options);
  EXPECT_FALSE(result.complete);
  const auto points = DisplacementMoments(result.sums).points();
  EXPECT_EQ(points.front().count, result.trajectories);
  EXPECT_EQ(points.back().count, result.trajectories);
}

TEST(Diffusion, RefusesMoreTimesThanItCanHold) {
  System system = lorentz("triangular", 2.2, 1, 10, 1);
  system.run.times.clear();
  for (int i = 1; i <= 3000; ++i) system.run.times.push_back(i / 300.0);
  EXPECT_THROW(run_diffusion(system), InputError);
}

}  // namespace
}  // namespace carom
