// A whole system as the engines see it: table, field, particles, initial condition, run.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "carom/base/exact_number.hpp"
#include "carom/events/dynamics.hpp"
#include "carom/motion/state.hpp"
#include "carom/system/section.hpp"
#include "carom/table/table.hpp"

namespace carom {

/// How initial states are chosen ([initial] of docs/guide/system-file.md).
struct InitialCondition {
  enum class Kind {
    uniform,
    sobol,
    boundary,
    hole,
    point,
    birkhoff,
    rectangle,
    line,
    list
  } kind = Kind::uniform;
  std::vector<int> walls;             ///< boundary, birkhoff: one after the other; none: all
  int hole = -1;                      ///< boundary, hole
  geometry::Vector position;          ///< point
  geometry::Vector velocity;          ///< point: direction, or the velocity where no speed is set
  geometry::Vector low, high;         ///< rectangle: min, max
  geometry::Vector from, to;          ///< line
  double angle = 0.0;                 ///< line: direction of flight against +x
  std::vector<double> s, v_parallel;  ///< birkhoff: one pair a particle (cyclic)
  std::vector<geometry::Vector> positions, velocities;  ///< list: of trajectory i (cyclic)
  Place place;  ///< where it is written, for messages about impossible starts
};

/// A t_max that means: until the cap on hits, however long it takes.
inline constexpr double no_last_time = 1e300;

/// How long orbits are followed, how many, and what is kept of them.
struct RunPlan {
  double t_max = 1000.0;
  std::uint64_t trajectories = 100000;
  std::uint64_t collisions = 0;  ///< cap on hits (0: none)
  std::uint64_t seed = 1;
  double sample = 0.0;             ///< time between samples (0: none)
  double trust_tolerance = 1e-3;   ///< of errors, relative to the table's size (trust/trust.hpp)
  std::vector<double> times = {};  ///< at which an ensemble is reported, in increasing order
  std::optional<std::pair<double, double>> window =
      {};                   ///< of fits: of a decay, and report times of D
  bool free_paths = false;  ///< are the lengths of flights counted (carom diffusion)?
  bool spectrum = false;    ///< are all exponents of all particles computed (carom lyapunov)?
};

/// Particles that enter through a hole during a run: the cosine law over its opening, inwards.
struct Injection {
  int hole = -1;
  std::vector<double> times;  ///< of entry, increasing; empty: by rate
  double rate = 0.0;          ///< mean number per unit time (Poisson process)
  Particle particle;          ///< of each that enters
  Place place;                ///< where it is written
};

/// A system file, read and checked: everything a run needs.
struct System {
  std::string name;  ///< as asked for on the command line
  std::string title;
  std::shared_ptr<const Table> table;
  std::vector<Particle> particles;  ///< one entry a particle; at least one
  std::vector<double> energies;     ///< total energy of each where energies are given, not speeds
  Dynamics dynamics;                ///< [[potential]], [interaction], [integrator]; --engine steps
  InitialCondition initial;
  std::vector<Injection> injections;  ///< [[injection]]
  RunPlan run;
  SectionPlan section;  ///< what `carom section` takes

  /// Are the starts quasi-random, and so not independent?
  bool quasi_random() const { return initial.kind == InitialCondition::Kind::sobol; }
  /// Do potentials or interactions act?
  bool has_forces() const { return dynamics.forces && !dynamics.forces->empty(); }
  /// Is motion integrated anywhere?
  bool is_integrated() const { return dynamics.everywhere || has_forces(); }
  /// Are the particles hard discs?
  bool of_discs() const { return dynamics.forces && !dynamics.forces->disc_radii().empty(); }
};

/// Do particles feel each other, or touch?
inline bool act_on_each_other(const System& system) {
  return system.of_discs() || (system.dynamics.forces && system.dynamics.forces->interacts());
}

/// Are there several that do?
inline bool feel_each_other(const System& system) {
  return system.particles.size() > 1 && act_on_each_other(system);
}

}  // namespace carom
