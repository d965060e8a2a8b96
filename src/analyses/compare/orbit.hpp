// One run of one scheme, and what a comparison looks at of it.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "carom/analyses/compare.hpp"
#include "carom/events/step_counts.hpp"
#include "carom/events/world.hpp"
#include "carom/geometry/vector.hpp"
#include "carom/system/system.hpp"

namespace carom::analyses {

/// A particle in the plane: on a lattice unwrapped.
struct PlaneState {
  geometry::Vector position, velocity;
};

struct ComparedHit {
  int particle = 0, wall = 0;
  double t = 0.0;
  geometry::Vector place;  ///< in the plane
};

/// At t; of one that has ended the last.
State state_of(const World&, int particle, double t);

/// Lengths and velocities by which errors are divided.
struct ErrorUnits {
  double size = 1.0, speed = 1.0;
};

/// A flight to a wall is rounded by some units: of the hit's place, the time and the velocity.
inline constexpr double rounding_of_flight = 0x1p-50;

/// A run is looked at this many times: energies at each, states at every fourth, and of these the
/// last eight are compared.
inline constexpr int looks = 64, looks_between_states = 4, states_compared = 8;

struct StateDistance {
  double position = 0.0, velocity = 0.0;
  double in(const ErrorUnits& units) const;
};

struct Orbit {
  std::string failure;                          ///< "": there is an orbit
  std::vector<std::vector<PlaneState>> states;  ///< at the times that are compared
  std::vector<ComparedHit> hits;
  StepCounts counts;
  double energy_change = 0.0, energy_trend = 0.0, trend_error = 0.0;  ///< as in ComparedRun
  double cpu_seconds = 0.0;
  std::optional<StateDistance> reversal;  ///< from the start, there and back; nothing: not known
};

/// The largest of any particle and time.
StateDistance distance(const Orbit&, const Orbit&);

/// Runs from one start.
class Runs {
 public:
  /// Refers to the system. Draws the start of that trajectory.
  Runs(const System&, std::uint64_t trajectory, std::function<bool()> stopped);

  const System& system() const { return system_; }
  const std::vector<State>& starts() const { return starts_; }
  /// The system's forces moved by this scheme; free particles are moved by it, too.
  Dynamics by(const std::string& scheme, double step, double tolerance) const;
  /// No force acts.
  bool free() const;
  /// Evaluations of single or pair forces that one evaluation of all costs.
  double weight() const;
  void add_starts(World&) const;

  enum class Part { orbit, everything };
  /// Follows the start until t, with the times of the CPU and the way back if everything is wanted.
  /// Throws SamplingStopped.
  Orbit fly(const Dynamics&, double t, Part) const;
  void stop_if_asked() const;

 private:
  void observe(World&, double t, Orbit&) const;
  void time(World&, double t, Orbit&) const;
  void turn_back(World&, double step, double t, Orbit&) const;

  const System& system_;
  std::function<bool()> stopped_;
  std::uint64_t trajectory_;
  std::vector<State> starts_;
};

/// In the plane.
PlaneState in_the_plane(const Table&, const State&);

}  // namespace carom::analyses
