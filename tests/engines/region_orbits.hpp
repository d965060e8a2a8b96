// Orbits through regions that tests compare.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "carom/events/world.hpp"
#include "carom/files/system_file.hpp"

namespace carom {

inline System system_of(const std::string& toml) { return read_system(toml, "test").system; }

inline State at(geometry::Vector position, geometry::Vector velocity) {
  State state;
  state.position = position;
  state.velocity = velocity;
  return state;
}

/// Two systems move a particle alike; the first one counts as many hits or more.
inline void expect_same_orbit(const System& with, const System& without, const State& start,
                              double time, double tolerance) {
  World one(*with.table, with.dynamics), other(*without.table, without.dynamics);
  one.add(with.particles[0], start);
  other.add(without.particles[0], start);
  one.run_until(time);
  other.run_until(time);
  const State a = one.state_at(0, time), b = other.state_at(0, time);
  EXPECT_NEAR(a.position.x, b.position.x, tolerance);
  EXPECT_NEAR(a.position.y, b.position.y, tolerance);
  EXPECT_GE(one.hits(0), other.hits(0));
}

/// Turned round at that time, a particle comes back; it had more than that many hits.
inline void expect_way_back(const System& system, const State& start, double time,
                            std::uint64_t hits, double tolerance) {
  World world(*system.table, system.dynamics);
  world.add(Particle(), start);
  world.run_until(time);
  State back = world.state_at(0, time);
  EXPECT_GT(world.hits(0), hits);
  back.velocity = -back.velocity;
  back.wall = -1;
  back.time = 0.0;
  world.clear();
  world.add(Particle(), back);
  world.run_until(time);
  const State there = world.state_at(0, time);
  EXPECT_NEAR(there.position.x, start.position.x, tolerance);
  EXPECT_NEAR(there.position.y, start.position.y, tolerance);
  EXPECT_NEAR(there.velocity.x, -start.velocity.x, tolerance);
}

}  // namespace carom
