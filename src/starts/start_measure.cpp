#include "carom/starts/start_measure.hpp"

#include <algorithm>

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

}  // namespace

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
  if (is_thermal(*system.table)) return "walls change the speeds";
  for (const Region& region : system.table->regions)
    if (region.index != 1.0) return "they are uniform where a refractive index differs";
  if (!system.has_forces()) return {};
  const ForceField& forces = *system.dynamics.forces;
  if (system.particles.size() > 1 && (system.of_discs() || forces.interacts()))
    return "the energy is divided among interacting particles by a rule";
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
