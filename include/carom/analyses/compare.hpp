// Integrators compared on a user's own system: error against work, scheme by scheme.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "carom/files/archive.hpp"
#include "carom/system/system.hpp"

namespace carom {

/// What is compared. Lists that are empty are chosen: docs/physics/comparing-integrators.md.
struct ComparePlan {
  std::vector<std::string> schemes = {};   ///< names; default_comparison() where empty
  std::vector<double> steps = {};          ///< > 0, of schemes with fixed steps (time)
  std::vector<double> tolerances = {};     ///< of adaptive schemes, from least_tolerance to below 1
  double t_max = 0.0;                      ///< time of the comparison; 0: chosen
  double error = 1e-6;                     ///< > 0: wanted error of the state
  std::uint64_t trajectory = 0;            ///< whose start is taken
  std::function<bool()> interrupted = {};  ///< asked between runs and within them
  std::function<void(std::size_t done, std::size_t all)> progress =
      {};  ///< called after each scheme
};

/// The schemes that are compared where none are named: one or two of each order, the magnetic ones
/// where there is a field, the system's own, and the adaptive ones.
std::vector<std::string> default_comparison(const System&);

/// What a scheme did with one step or tolerance. Errors of the state are the larger one of
/// |dx|/size and |dv|/speed (Comparison), the largest over the particles and eight times in the
/// second half of the comparison.
struct ComparedRun {
  double step = 0.0;       ///< 0: adaptive
  double tolerance = 0.0;  ///< 0: fixed steps
  /// Why there is no result: the steps do not resolve the forces, or the like; "": there is one.
  std::string failure;
  double error_state = 0.0;
  double error_position = 0.0, error_velocity = 0.0;  ///< length, length/time
  double error_energy = 0.0;  ///< largest change over the largest kinetic energy
  double energy_trend = 0.0;  ///< of the same, per time: the slope through means of blocks
  double trend_error = 0.0;   ///< its standard error
  std::uint64_t hits = 0;     ///< that it has in common with the reference, from the first on
  bool same_hits = true;      ///< they are all hits of both
  double error_hit_time = 0.0, error_hit_place = 0.0;  ///< largest of these (time, length)
  /// Of the start, there and back again, as error_state; not a number where there is no way back:
  /// the run is a single step, or a trajectory ends.
  double error_reversal = std::numeric_limits<double>::quiet_NaN();
  double rounding = 0.0;         ///< what rounding may have made of error_state
  std::uint64_t unresolved = 0;  ///< steps that do not resolve the forces, where these are counted
  std::uint64_t steps = 0, force_evaluations = 0;
  double cpu_seconds = 0.0;  ///< least of several runs

  bool failed() const { return !failure.empty(); }
};

/// A number with an error.
struct MeasuredNumber {
  double value = 0.0, error = 0.0;
};

/// The slope of log error against log step where it has settled.
struct MeasuredOrder {
  std::optional<MeasuredNumber> slope;
  double longest = 0.0, shortest = 0.0;  ///< steps that it rests on
  int steps = 0;                         ///< how many
  std::string reason;                    ///< why there is none
};

/// The work for the wanted error, between two runs by logarithms.
struct WorkForError {
  double step = 0.0, tolerance = 0.0;  ///< one of them
  double force_evaluations = 0.0, cpu_seconds = 0.0;
};

struct ComparedScheme {
  std::string name;
  int order = 0;  ///< stated; 0: varies
  bool adaptive = false;
  std::vector<ComparedRun> runs;  ///< from the longest step on
  MeasuredOrder measured;
  std::optional<WorkForError> work;  ///< nothing: the wanted error is not reached
  /// How far a step is from a symplectic map, and the error of the measuring; nothing where no
  /// step between hits was found.
  std::optional<MeasuredNumber> areas;
  double areas_step = 0.0;  ///< the length of these steps
  /// Of the longest steps that measure it: does the way back lead to the start except for rounding?
  std::optional<bool> reversible;
};

/// A particle of the reference at the end, in the plane (unwrapped on a lattice).
struct ComparedEnd {
  double x = 0.0, y = 0.0, vx = 0.0, vy = 0.0;  ///< length, length/time
};

struct Comparison {
  double t = 0.0;                  ///< time of the comparison
  double growth = 1.0;             ///< of distances of neighbouring orbits until then
  double size = 1.0, speed = 1.0;  ///< units of error_state (length, length/time)
  double error = 0.0;              ///< that is wanted
  bool exact = false;              ///< reference: exact flights, else a scheme
  std::string reference;           ///< its scheme
  double reference_step = 0.0, reference_error = 0.0;
  std::vector<ComparedEnd> end;   ///< of the reference, one a particle
  std::uint64_t hits = 0;         ///< of the reference
  double longest_resolved = 0.0;  ///< of the steps that were tried; 0: no forces
  std::vector<ComparedScheme> schemes;
  std::optional<std::size_t> cheapest, fastest;  ///< by force evaluations, by CPU time
  bool complete = true;                          ///< false: interrupted
  double seconds = 0.0, cpu_seconds = 0.0;
};

/// Sets `cheapest` and `fastest` by the work of the schemes.
void name_best_schemes(Comparison&);

/// Compares schemes on the system's forces, walls and start. Free systems are integrated all the
/// same, as with --engine steps, and compared with exact flights. Throws InputError for hard discs,
/// injections, unknown schemes, a start that ends at once, and where no step resolves the forces;
/// SamplingStopped.
Comparison compare(const System&, const ComparePlan& = {});

/// Writes aside and renames: the archive is there whole or not at all.
void write_comparison(const std::string& file, const LoadedSystem&, const Provenance&,
                      const Comparison&, bool force, ArchiveLock = nullptr);

/// A comparison as its archive holds it.
struct StoredComparison {
  std::string system_name, system_toml, engine;
  Comparison result;
};
/// Throws InputError for anything but the archive of a comparison.
StoredComparison read_comparison(const std::string& file);

}  // namespace carom
