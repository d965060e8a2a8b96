// Equilibria: where all forces vanish, their energies and small oscillations; their archive.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "carom/base/fields.hpp"
#include "carom/files/archive.hpp"
#include "carom/geometry/vector.hpp"
#include "carom/system/system.hpp"

namespace carom {

/// A small motion exp((growth + i frequency) t) about an equilibrium (both 1/time).
struct NormalMode {
  double frequency = 0.0;  ///< >= 0
  double growth = 0.0;     ///< > 0: it leaves; 0: it oscillates, or rests where the frequency is 0
};

template <>
struct Fields<NormalMode> {
  static constexpr std::tuple list{
      field("frequency", "1/time", "Angular frequency", &NormalMode::frequency),
      field("growth", "1/time", "Rate of growth", &NormalMode::growth)};
};

/// A place where the potential energy of all particles is stationary.
struct Equilibrium {
  double energy = 0.0;  ///< of all particles
  /// Bounds of the rounding of energy (its terms, each rounded), and of a coordinate: the last step
  /// of Newton's method.
  double energy_error = 0.0, position_error = 0.0;
  int descending = 0;  ///< directions in which the energy falls: 0 at a minimum, else a saddle
  int neutral = 0;     ///< directions in which it does not change to second order: symmetries
  std::vector<geometry::Vector> positions;
  std::vector<int> walls;  ///< that a particle is pressed on; -1: none
  /// In falling order of frequency, then rising order of growth: one a degree of freedom. A
  /// particle on a wall moves along it.
  std::vector<NormalMode> modes;
  std::uint64_t first = 0;  ///< the first start that led here
  std::uint64_t found = 0;  ///< how many starts did, symmetric copies included
  bool minimum() const { return descending == 0; }
};

template <>
struct Fields<Equilibrium> {
  using E = Equilibrium;
  static constexpr std::tuple list{
      field("energy", "energy", "Potential energy of all particles", &E::energy),
      field("energy_error", "energy", "Bound of its rounding", &E::energy_error),
      field("position_error", "length", "Error of a coordinate", &E::position_error),
      field_as<std::int64_t>("descending", "1",
                             "Directions in which the energy falls; 0: a minimum", &E::descending),
      field_as<std::int64_t>("neutral", "1",
                             "Directions in which it does not change to second order", &E::neutral),
      field("found", "1", "Starts that led here, or to a symmetric copy", &E::found),
      field("first", "1", "Trajectory whose start first led here", &E::first)};
};

/// How to search.
struct RelaxOptions {
  std::uint64_t starts = 200;  ///< trajectories 0 ... starts - 1 of the system's ensemble
  bool saddles = false;        ///< look for saddles, too
  int threads = 0;             ///< 0: as many as OpenMP gives
  const std::atomic<bool>* interrupted = nullptr;
  std::function<void(std::uint64_t starts)> progress;
};

struct RelaxResult {
  std::vector<Equilibrium> equilibria;  ///< each once, in rising order of energy
  std::uint64_t starts = 0;             ///< that were followed
  std::uint64_t without = 0;  ///< searches that came to none: where nothing holds the particles the
                              ///< energy falls for ever
  bool complete = true;
  int threads = 1;
  double seconds = 0.0, cpu_seconds = 0.0;
};

template <>
struct Fields<RelaxResult> {
  static constexpr std::tuple list{
      field("starts", "1", "Starts that were followed", &RelaxResult::starts),
      field("without", "1", "Searches that found no equilibrium", &RelaxResult::without)};
};

/// Minimises the potential energy from the starts of the system (docs/physics/equilibria.md). The
/// same equilibria on any number of threads. Throws InputError where nothing acts.
RelaxResult run_relax(const System&, const RelaxOptions& = {});

/// Writes /equilibria: aside, and renamed when it is whole.
void write_equilibria(const std::string& file, const LoadedSystem&, const Provenance&,
                      const RelaxResult&, bool force, ArchiveLock = nullptr);

/// Equilibria as their archive holds them.
struct StoredEquilibria {
  std::string system_name, system_toml;
  RelaxResult result;
};
/// Throws InputError for anything but such an archive.
StoredEquilibria read_equilibria(const std::string& file);

}  // namespace carom
