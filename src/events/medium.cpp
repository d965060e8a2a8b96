#include "carom/events/medium.hpp"

#include <cmath>

#include "base/index.hpp"

namespace carom {

Particle in_region(const Table& table, const Particle& outside, int region) {
  if (region < 0) return outside;
  const Region& r = table.regions[base::at(region)];
  Particle there = outside;
  if (r.field) there.omega = outside.charge * *r.field / outside.mass;
  if (r.index != 1.0) there.speed = outside.speed / r.index;
  if (r.potential != 0.0) {
    const double square = outside.speed * outside.speed - 2.0 * r.potential / outside.mass;
    there.speed = square > 0.0 ? std::sqrt(square) : 0.0;
  }
  return there;
}

double momentum_in(const Table& table, const Particle& outside, int region) {
  if (region < 0) return 1.0;
  const Region& r = table.regions[base::at(region)];
  return r.potential != 0.0 ? in_region(table, outside, region).speed / outside.speed : r.index;
}

}  // namespace carom
