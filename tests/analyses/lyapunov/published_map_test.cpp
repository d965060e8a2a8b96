// Growth of deviations in a Lorentz gas against the map of Ch. Dellago, H. A. Posch, W. G. Hoover,
// Phys. Rev. E 53, 1485 (1996): displacements in all four dimensions of phase space, each carried
// to its own collision. Nothing here is of motion/.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "carom/engines/engine.hpp"
#include "carom/engines/trajectories.hpp"
#include "carom/files/system_file.hpp"
#include "carom/geometry/curve.hpp"
#include "carom/starts/sampler.hpp"

namespace carom {
namespace {

using geometry::Vector;

struct Displacement {
  Vector place, velocity;
};

// At a disc: the displaced particle hits a time dt later, at a normal turned by dn.
Displacement collided(const Displacement& d, const Vector& v, const Vector& n, double radius) {
  const double dt = -dot(d.place, n) / dot(v, n);
  const Vector there = d.place + dt * v, dn = (1 / radius) * there;
  const auto mirrored = [&](const Vector& a) { return a - (2 * dot(a, n)) * n; };
  return {there - dt * mirrored(v), mirrored(d.velocity) - 2.0 * (dot(v, dn) * n + dot(v, n) * dn)};
}

struct Hits : Observer {
  void hit(const HitEvent& e) override { list.push_back(e); }
  std::vector<HitEvent> list;
};

struct Logarithms : Listener {
  void stretched(const Trajectory&, int, std::size_t number, std::span<const double> lengths,
                 std::uint64_t) override {
    if (number == 1) found.assign(lengths.begin(), lengths.end());
  }
  void end(const Trajectory&, const TrajectoryEnd&) override {}
  std::vector<double> found;
};

TEST(Deviations, GrowByTheMapOfDellagoPoschAndHoover) {
  const System system = load_system("lorentz-triangular", {}).system;
  const double radius = 1.0, t_end = 40.0;
  Logarithms engine;
  const Sampler sampler(system);
  DrawnStarts starts(sampler, TrajectoryRange{7, 8});
  make_engine(system, {.t_end = t_end, .deviations = {t_end / 2, t_end}})->run(starts, engine);
  ASSERT_EQ(engine.found.size(), 2u);

  World world = make_world(system);
  add_starts(world, sampler, 7);
  const State start = world.state(0);
  Hits hits;
  world.run_until(t_end, hits);
  ASSERT_GT(hits.list.size(), 20u);
  const Vector across = left(start.velocity);  // speed 1
  for (const int which : {0, 1}) {             // the two with which the engine begins
    double logarithm = 0.0;
    const double place = which == 0 ? 0.6 : -0.8, rate = which == 0 ? 0.8 : 0.6;
    Displacement d{place * across, rate * across};
    Time last;
    Vector v = start.velocity;
    for (const HitEvent& e : hits.list) {
      d.place = d.place + (e.time - last) * d.velocity;
      const Vector n =
          (1 / radius) *
          (e.position - std::get<geometry::Circle>(system.table->wall(e.wall).curve).centre);
      d = collided(d, v, n, radius);
      v = e.after;
      last = e.time;
      const double size = std::sqrt(dot(d.place, d.place) + dot(d.velocity, d.velocity));
      d = {(1 / size) * d.place, (1 / size) * d.velocity};
      logarithm += std::log(size);
    }
    d.place = d.place + (Time(t_end) - last) * d.velocity;
    const double there = dot(left(v), d.place), turn = dot(left(v), d.velocity);
    logarithm += 0.5 * std::log(there * there + turn * turn);
    EXPECT_NEAR(logarithm, engine.found[static_cast<std::size_t>(which)], 1e-9 * t_end) << which;
  }
}

}  // namespace
}  // namespace carom
