#include "carom/starts/start_measure.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/index.hpp"
#include "carom/base/elementary.hpp"
#include "carom/events/medium.hpp"

namespace carom {

namespace {

using Kind = InitialCondition::Kind;

bool lets_go(const Table& table) {
  return table.extent == Extent::open_plane ||
         std::any_of(table.walls.begin(), table.walls.end(),
                     [](const Wall& wall) { return !wall.holes.empty(); });
}

bool on_all_walls(const System& system) {
  const InitialCondition& initial = system.initial;
  return initial.kind == Kind::boundary && initial.hole < 0 &&
         (initial.walls.empty() || initial.walls.size() == system.table->walls.size());
}

// Is the fraction that is mirrored the same from either side, as rays run backwards? `n`: the
// momentum behind the edge over that before it.
bool is_balanced(const TypedExpression& fraction, double n) {
  constexpr int angles = 64;
  for (int k = 1; k < angles; ++k) {
    const double sine = elementary::sin(0.5 * std::numbers::pi * k / angles);
    // On the side with the larger momentum directions beyond the critical one are mirrored anyway.
    const double beyond = n < 1.0 ? sine : sine / n, before = n < 1.0 ? sine * n : sine;
    const double to = elementary::atan2(beyond, std::sqrt((1.0 - beyond) * (1.0 + beyond))),
                 from = elementary::atan2(before, std::sqrt((1.0 - before) * (1.0 + before)));
    const double there = fraction.value(std::array{from, to, n}),
                 back = fraction.value(std::array{to, from, 1.0 / n});
    // Far above what a formula rounds, and far below what counts of hits could show.
    constexpr double roundings = 1e-9;
    if (!(std::fabs(there - back) <= roundings)) return false;
  }
  return true;
}

// Of all edges between regions.
bool all_are_balanced(const System& system) {
  const Table& table = *system.table;
  for (int w = 0; w < static_cast<int>(table.walls.size()); ++w) {
    if (!is_passed(table.wall(w)) || !is_inner_side(table, w)) continue;
    const int within = region_of(table, w), outside = region_of(table, table.wall(w).twin);
    const Region& region = table.regions[base::at(within)];
    if (!region.fraction) continue;
    for (const Particle& particle : system.particles) {
      const double here = momentum_in(table, particle, outside),
                   there = momentum_in(table, particle, within);
      if (here > 0.0 && there > 0.0 && !is_balanced(*region.fraction, there / here)) return false;
    }
  }
  return true;
}

}  // namespace

std::string why_not_uniform(const System& system) {
  const Table& table = *system.table;
  if (is_thermal(table)) return "walls change the speeds";
  for (const Wall& wall : table.walls)
    if (wall.roughness > 0.0) return "rough walls keep no uniform density";
  for (const Region& region : table.regions)
    if (region.index != 1.0) return "they are uniform where a refractive index differs";
  if (!all_are_balanced(system))
    return "an edge mirrors another fraction of the hits on the way back";
  return {};
}

std::string why_not_stationary(const System& system) {
  if (!system.injections.empty()) return "particles enter during the run";
  switch (system.initial.kind) {
    case Kind::uniform:
    case Kind::sobol:
      break;
    case Kind::boundary:
      return on_all_walls(system) ? "they are on the walls" : "they are on a part of the walls";
    case Kind::hole:
      return "they are in a hole";
    case Kind::rectangle:
      return "they are in a rectangle";
    case Kind::line:
      return "they are on a line";
    case Kind::point:
      return "they are at one point";
    case Kind::birkhoff:
    case Kind::list:
      return "they are listed";
  }
  if (lets_go(*system.table)) return "particles leave";
  if (std::string why = why_not_uniform(system); !why.empty()) return why;
  if (feel_each_other(system)) return "the energy is divided among interacting particles by a rule";
  if (!system.has_forces()) return {};
  const ForceField& forces = *system.dynamics.forces;
  if (forces.external() && system.energies.empty())
    return "they have one speed where the potential differs";
  return {};
}

bool starts_of_the_map(const System& system) {
  return on_all_walls(system) && !lets_go(*system.table) && system.injections.empty() &&
         !system.is_integrated();
}

System with_starts_of_the_flow(System system) {
  if (starts_of_the_map(system)) system.initial.kind = Kind::uniform;
  return system;
}

}  // namespace carom
