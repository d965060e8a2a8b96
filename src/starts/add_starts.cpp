// Starts on their way into a world.
#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <stdexcept>

#include "carom/base/error.hpp"
#include "carom/events/world.hpp"
#include "carom/starts/sampler.hpp"
#include "events/step/group.hpp"
#include "starts/start_formulas.hpp"

namespace carom {

using geometry::Vector;
using starts::impossible;
using Kind = InitialCondition::Kind;

std::uint64_t listed_trajectories(const System& system) {
  const std::uint64_t particles = system.particles.size();
  const auto shared = [&](std::size_t starts) {
    return std::max<std::uint64_t>(1, (starts + particles - 1) / particles);
  };
  switch (system.initial.kind) {
    case Kind::birkhoff:
      return shared(system.initial.s.size());
    case Kind::list:
      return shared(system.initial.positions.size());
    case Kind::point:
      return 1;
    default:
      return 0;
  }
}

void fold_into_cell(const Table& table, Vector& position, geometry::Cell& cell) {
  if (!table.lattice) return;
  const geometry::Lattice& lattice = *table.lattice;
  // First the whole number of cells from the solution of position - centre = a first + b second,
  // then edge by edge. Each subtraction is rounded; the folded position is the start, exactly. The
  // home cell lies about its walls, be they many cells from the origin.
  const Vector from_centre = position - events::centre_of_cell(lattice);
  const double area = cross(lattice.first, lattice.second);
  const double a = std::nearbyint(cross(from_centre, lattice.second) / area);
  const double b = std::nearbyint(cross(lattice.first, from_centre) / area);
  if (!(std::abs(a) < 0x1p52 && std::abs(b) < 0x1p52)) return;
  const auto move = [&](const geometry::Cell& by) {
    position = position - lattice.translation(by);
    cell.first += by.first;
    cell.second += by.second;
  };
  // A start in the home cell, its edges included, is not touched.
  const auto edge_passed = [&] {
    return std::find_if(
        lattice.edges.begin(), lattice.edges.end(), [&](const geometry::CellEdge& edge) {
          return cross(edge.segment.to - edge.segment.from, position - edge.segment.from) < 0.0;
        });
  };
  if (edge_passed() == lattice.edges.end()) return;
  move({static_cast<std::int64_t>(a), static_cast<std::int64_t>(b)});
  for (int i = 0; i < 16; ++i) {
    const auto edge = edge_passed();
    if (edge == lattice.edges.end()) return;
    move(edge->beyond);
  }
}

int add_start(World& world, const System& system, const State& state, std::uint64_t trajectory,
              int particle) {
  world.scatter_by(system.run.seed, trajectory);
  try {
    return world.add(system.particles.at(static_cast<std::size_t>(particle)), state);
  } catch (const std::invalid_argument& error) {
    throw impossible(system.initial,
                     fmt::format("trajectory {} cannot start at ({}, {}): {}", trajectory,
                                 state.position.x, state.position.y, error.what()));
  }
}

int add_start(World& world, const Sampler& sampler, std::uint64_t trajectory, int particle) {
  return add_start(world, sampler.system(), sampler.draw(world, trajectory, particle), trajectory,
                   particle);
}

void add_starts(World& world, const Sampler& sampler, std::uint64_t trajectory) {
  const std::vector<State> states = sampler.draw_all(world, trajectory);
  for (std::size_t p = 0; p < states.size(); ++p) {
    if (sampler.stopped()) throw SamplingStopped();
    add_start(world, sampler.system(), states[p], trajectory, static_cast<int>(p));
  }
}

void check_start(const System& system, const std::atomic<bool>* interrupted) {
  World world(*system.table, system.dynamics);
  try {
    add_starts(world, Sampler(system, interrupted), 0);
  } catch (const SamplingStopped&) {  // so does what comes next
  }
}

State draw_initial_state(const System& system, const World& world, std::uint64_t trajectory,
                         int particle) {
  return Sampler(system).draw(world, trajectory, particle);
}

}  // namespace carom
