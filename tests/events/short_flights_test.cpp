// Flights of no length beside a joint, in a field: a hit that lies close comes soon, not a full
// turn later.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <stdexcept>

#include "carom/events/world.hpp"
#include "random_tables.hpp"
#include "recorder.hpp"

namespace carom {
namespace {

using tests::Dice;
using tests::Shape;

std::optional<HitEvent> first_hit(const Table& table, const Particle& particle, const State& start,
                                  double inflation) {
  World world(table, DecisionOptions{inflation});
  world.limit_hits(1);
  try {
    world.add(particle, start);
  } catch (const std::invalid_argument&) {
    return std::nullopt;  // rounding has turned the velocity outwards
  }
  tests::Recorder recorder;
  world.run_until(1e3, recorder);
  if (recorder.hits.empty()) return std::nullopt;
  return recorder.hits.front();
}

TEST(ShortFlights, AreNoFullTurns) {
  Dice dice(3);
  long beside = 0;
  const Shape shapes[] = {Shape::polygon, Shape::arcs, Shape::stadium, Shape::mushroom,
                          Shape::elliptic_arcs};
  const long all = tests::cases(50, 3000);
  for (long n = 0; n < all; ++n) {
    const Table table =
        tests::random_table(shapes[n % 5], 1.0, {dice.between(-3, 3), dice.between(-3, 3)}, dice);
    for (int w = 0; w < static_cast<int>(table.walls.size()); ++w) {
      const Wall& wall = table.walls[static_cast<std::size_t>(w)];
      if (geometry::is_closed(wall.curve)) continue;
      for (int k = 0; k < 6; ++k) {
        // Beside the wall's start, and towards it.
        State start;
        start.wall = w;
        start.u = std::ldexp(dice.between(1, 2), -dice.whole(44, 53));
        start.position = geometry::point_at(wall.curve, start.u);
        const double angle = -dice.between(0.05, 1.5);
        start.velocity = std::cos(angle) * geometry::normal_at(wall.curve, start.u) +
                         std::sin(angle) * geometry::tangent_at(wall.curve, start.u);
        Particle particle;
        particle.omega = dice.between(-2, 2);
        particle.speed = std::sqrt(dot(start.velocity, start.velocity));
        const auto hit = first_hit(table, particle, start, 1.0);
        if (!hit || hit->wall != wall.previous) continue;
        const geometry::Vector way = hit->position - start.position;
        EXPECT_GT(hit->time.value(), 0.0);
        if (std::sqrt(dot(way, way)) < 1e-9) {
          ++beside;
          EXPECT_LT(hit->time.value(), 1e-8)
              << "wall " << w << " u " << start.u << " omega " << particle.omega;
        }
        for (const double inflation : {0x1p20, 1e300}) {
          const auto same = first_hit(table, particle, start, inflation);
          ASSERT_TRUE(same);
          EXPECT_EQ(same->time, hit->time) << inflation;
          EXPECT_EQ(same->u, hit->u) << inflation;
        }
      }
    }
  }
  EXPECT_GT(beside, 3 * all);
}

}  // namespace
}  // namespace carom
