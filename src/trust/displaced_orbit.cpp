#include "trust/displaced_orbit.hpp"

#include <algorithm>
#include <stdexcept>

#include "carom/trust/trust.hpp"

namespace carom::trust {

using geometry::Vector;

namespace {}  // namespace

double size_of_positions(const System& system, const World& world, double time) {
  if (!system.table->walls.empty() || system.table->lattice) return size_of(*system.table);
  double size = 0.0, fastest = 0.0;
  for (int i = 0; i < world.size(); ++i) {
    size = std::max(size, length(world.state(i).position));
    fastest = std::max(fastest, length(world.state(i).velocity));
  }
  if (size > 0.0) return size;
  return fastest > 0.0 ? fastest * time : 1.0;
}

void add_displaced(World& world, const World& others, double size) {
  for (int i = 0; i < others.size(); ++i) {
    const State& start = others.state(i);
    bool added = false;
    for (const double share : {displacement, -displacement, 0.0}) {
      State s = start;
      if (s.wall < 0) s.position = s.position + (share * size) * Vector{0.6, 0.8};
      s.velocity = s.velocity + share * geometry::left(s.velocity);
      try {
        world.add(others.particle(i), s);
        added = true;
      } catch (const std::invalid_argument&) {  // outside of the table, or out of the wall
      }
      if (added) break;
    }
  }
}

}  // namespace carom::trust
