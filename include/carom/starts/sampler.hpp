// Initial states of trajectories, a function of (seed, trajectory, particle) alone.
#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "carom/geometry/curve_frame.hpp"
#include "carom/system/system.hpp"

namespace carom {

class RandomStream;
class World;

namespace starts {
class QuasiRandom;
}

/// Thrown where sampling was asked to stop before it found a start.
class SamplingStopped : public std::exception {
 public:
  const char* what() const noexcept override { return "stopped before a start was found"; }
};

/// Draws initial states (docs/guide: [initial]). Only + - * / sqrt and base/elementary make a
/// state.
///
///   uniform    position uniform in the table or cell, direction uniform
///   sobol      the same, quasi-random: single particles, trajectory i in replicate i mod 16
///   rectangle  the same in the part of a rectangle that lies in the domain
///   line       position uniform in the part of a line that lies in the domain, direction given
///   boundary   cosine law: uniform in arc length and tangential velocity, from one wall or all
///   hole       cosine law over the opening of one hole or all
///   birkhoff   given arc length and tangential velocity, one pair for each particle
///   point      given position and velocity
///   list       the same, one of a list for each particle of each trajectory
///
/// Under forces a given energy is the total energy. A position where the potential exceeds it is
/// drawn again; elsewhere the speed follows from the difference. Interacting particles share the
/// sum of their energies: the sum less their potential energy is divided equally among them as
/// kinetic energy (Bill2d, section 4.1). If it is negative all are drawn again. Hard discs are
/// drawn again until none overlap; they cannot start on a wall.
class Sampler {
 public:
  /// Refers to the system. `stopped` is asked every few hundred draws, from any thread: starts may
  /// be very rare.
  explicit Sampler(const System&, std::function<bool()> stopped = {});
  Sampler(const System&, const std::atomic<bool>* interrupted);
  const System& system() const { return system_; }
  bool stopped() const { return stopped_ && stopped_(); }

  /// The state of particle `particle` of trajectory `trajectory`. `world` answers which points lie
  /// in the domain. Throws InputError when the initial condition is impossible, and
  /// SamplingStopped.
  State draw(const World& world, std::uint64_t trajectory, int particle) const;
  /// The states of all particles of a trajectory.
  std::vector<State> draw_all(const World& world, std::uint64_t trajectory) const;
  /// The states of the first particles of trajectories that follow each other, each as `draw` gives
  /// it.
  void draw_several(const World& world, std::uint64_t first, std::span<State> states) const;
  /// A start on the boundary, of the kinds `boundary` and `hole`.
  State cosine_law(RandomStream&, double speed) const;

 private:
  /// An interval of a wall's parameter that cosine-law starts are drawn from. |dr/du| <= bound on
  /// it.
  struct Source {
    int wall;
    double from, to;
    double bound,
        weight;  ///< weight: bound * (to - from), summed over the sources before it and itself
  };

  /// `again`: after a start that could not be taken, whose quasi-random point is used up.
  State draw_free(const World&, RandomStream&, std::uint64_t trajectory, int particle,
                  bool again = false) const;
  State quasi_random(const World&, RandomStream&, std::uint64_t trajectory, double speed,
                     bool again) const;
  State draw_external(const World&, std::uint64_t trajectory, int particle) const;
  std::vector<State> draw_discs(const World&, std::uint64_t trajectory) const;
  bool random_positions() const;
  bool draws_free_points() const;
  bool admits(const World&, const State&) const;
  void prepare_quasi_random();
  void add_holes(int hole);
  void add_source(int wall, double from, double to);
  static std::int64_t patience(std::int64_t of_the_first, std::uint64_t trajectory);
  void stop_if_asked(std::int64_t tries) const {
    if (tries % 256 == 255 && stopped()) throw SamplingStopped();
  }
  State in_box(const World&, RandomStream&, std::uint64_t trajectory, geometry::Vector low,
               geometry::Vector high, double speed, const char* where) const;
  State on_line(const World&, RandomStream&, std::uint64_t trajectory, double speed) const;
  State at_point(const World&, geometry::Vector position, geometry::Vector velocity,
                 double speed) const;
  State birkhoff(std::uint64_t number, double speed) const;
  /// `tangential` and `normal` give the direction against the wall, in any unit.
  State on_wall(int wall, double u, double tangential, double normal, double speed) const;

  const System& system_;
  std::function<bool()> stopped_;
  std::vector<geometry::CurveFrame> frames_;  ///< one a wall
  std::vector<int> walls_;                    ///< of starts on walls: those that are named, or all
  std::vector<Source> sources_;
  geometry::Vector low_, high_;                              ///< uniform: box around the domain
  std::shared_ptr<const starts::QuasiRandom> quasi_random_;  ///< sobol
};

/// Adds a particle that was drawn to the world; returns its number there. Throws InputError.
int add_start(World&, const System&, const State&, std::uint64_t trajectory, int particle);
/// Draws it as well.
int add_start(World&, const Sampler&, std::uint64_t trajectory, int particle);
/// Draws and adds all particles of a trajectory.
void add_starts(World&, const Sampler&, std::uint64_t trajectory);
/// How many trajectories start differently where starts are listed (point, list, birkhoff): later
/// ones repeat them. 0 where starts are drawn.
std::uint64_t listed_trajectories(const System&);
/// Throws InputError where errors are stated that hold for independent starts alone.
void refuse_quasi_random(const System&, const char* what);
/// Throws InputError if the first trajectory cannot start. Interrupted, it returns
/// without an answer.
void check_start(const System&, const std::atomic<bool>* interrupted = nullptr);
/// One state by a sampler made on the spot.
State draw_initial_state(const System&, const World& world, std::uint64_t trajectory, int particle);

/// The same point of the plane seen from its own cell of the lattice: subtracts lattice vectors
/// from `position` and counts them in `cell` until it lies in the cell. Tables without a lattice:
/// nothing.
void fold_into_cell(const Table&, geometry::Vector& position, geometry::Cell& cell);

}  // namespace carom
