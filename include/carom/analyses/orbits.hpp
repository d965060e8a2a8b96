// The search for periodic orbits.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "carom/certify/certified_periodic_orbit.hpp"
#include "carom/files/archive.hpp"
#include "carom/files/system_file.hpp"
#include "carom/orbits/cycle_expansion.hpp"
#include "carom/orbits/periodic_orbit.hpp"
#include "carom/system/system.hpp"

namespace carom {

/// What is looked for, and how hard.
struct OrbitSearchOptions {
  std::uint64_t most_hits = 6;   ///< of an orbit, from 2; on a lattice in a field from 1
  std::uint64_t starts = 20000;  ///< trajectories whose recurrences are looked at
  std::uint64_t tries = 2000;    ///< recurrences that are tried for each number of hits
  bool expand_cycles = false;    ///< rate and exponent from the orbits: discs in the open plane
  int threads = 0;               ///< 0: as many as OpenMP gives
  const std::atomic<bool>* interrupted = nullptr;
  /// Of the starts that are flown, and then of the chains of hits that are tried.
  std::function<void(std::uint64_t done, std::uint64_t all)> progress = {};
};

/// Most words that a search goes through.
inline constexpr std::uint64_t most_words = 1'000'000;

struct OrbitSearchResult {
  /// Each once except for shift, reversal and symmetries of the table, by number of hits and
  /// length.
  std::vector<PeriodicOrbit> orbits;
  std::uint64_t words = 0;        ///< cyclic words of discs that were tried; 0: none
  std::uint64_t recurrences = 0;  ///< of orbits from random starts that were tried
  std::uint64_t unsolved = 0;     ///< Newton's steps did not end at an orbit
  std::uint64_t shadowed = 0;     ///< solved, but a wall is in the way
  std::uint64_t symmetries = 1;   ///< isometries of the table
  std::optional<CycleExpansion> cycles;
  bool complete = true;  ///< not interrupted
  double seconds = 0, cpu_seconds = 0;
  int threads = 1;
};

/// The counts.
template <>
struct Fields<OrbitSearchResult> {
  using R = OrbitSearchResult;
  static constexpr std::tuple list{
      field("words", "1", "Cyclic words of discs that were tried", &R::words),
      field("recurrences", "1", "Recurrences that were tried", &R::recurrences),
      field("unsolved", "1", "Starts that led to no orbit", &R::unsolved),
      field("shadowed", "1", "Starts that led to one with a wall in its way", &R::shadowed),
      field("symmetries", "1", "Isometries of the table", &R::symmetries)};
};

/// Looks for the periodic orbits of one free particle, holes closed. Between discs in the open
/// plane it tries every cyclic word of discs: without field these are all orbits of separate
/// discs. Elsewhere it tries the closest recurrences of random orbits, and may miss orbits. The
/// same orbits on any number of threads. Throws InputError where there is no such particle or
/// nothing to hit.
OrbitSearchResult find_orbits(const System&, const OrbitSearchOptions& = {});

/// The proof of an orbit in decimals; "" is no number.
struct ProofOfOrbit {
  bool proven = false;
  std::string reason;  ///< why it is not
  std::string period, length, trace, multiplier;
  std::vector<std::string> x, y;  ///< of each hit
};
/// Proofs of orbits, in their order; fewer after an interrupt, none if they were not asked for.
struct ProofsOfOrbits {
  int digits = 20;  ///< decimals that are guaranteed
  std::vector<ProofOfOrbit> orbits;
};
ProofOfOrbit proof_of(const CertifiedPeriodicOrbit&, int digits);

/// What a search found, as its archive holds it; `status` is "completed" or "interrupted".
struct StoredOrbits {
  std::string system_name, system_toml, status;
  std::uint64_t most_hits = 0;
  OrbitSearchResult result;
  ProofsOfOrbits proofs;
};

/// Writes the archive, aside, and gives it its name when it is whole. Throws InputError where the
/// file exists and `force` is not set.
void write_orbits(const std::string& file, const LoadedSystem&, const Provenance&,
                  const OrbitSearchResult&, const ProofsOfOrbits&, std::uint64_t most_hits,
                  bool force, ArchiveLock = nullptr);
/// Throws InputError for anything but such an archive. Times and threads are not among it.
StoredOrbits read_orbits(const std::string& file);

}  // namespace carom
