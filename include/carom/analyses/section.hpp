// Sections of many orbits.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "carom/events/decisions.hpp"
#include "carom/events/energy.hpp"
#include "carom/events/step_counts.hpp"
#include "carom/files/archive.hpp"
#include "carom/lanes/instruction_set.hpp"
#include "carom/results/fate_counts.hpp"
#include "carom/system/section.hpp"
#include "carom/system/system.hpp"

namespace carom {

/// How to run, without influence on the result.
struct SectionOptions {
  int threads = 0;  ///< 0: as many as OpenMP gives
  DecisionOptions decisions;
  std::optional<InstructionSet> lanes = widest_instruction_set();  ///< empty: one by one
  const std::atomic<bool>* interrupted = nullptr;
  std::function<void(std::uint64_t orbits, std::uint64_t points)> progress;
  /// If set, receives the points, orbit after orbit (one thread at a time).
  std::function<void(const std::vector<SectionPoint>&)> points;
};

/// What a section run counts; the points themselves go to SectionOptions::points.
struct SectionResult : FateCounts {
  std::uint64_t orbits = 0;  ///< trajectories that were followed to their end
  std::uint64_t points = 0, collisions = 0;
  std::uint64_t incomplete = 0;  ///< particles that met the section less often than asked for
  std::uint64_t digest = 0;      ///< sum of a hash of each particle's points
  bool complete = true;
  double seconds = 0, cpu_seconds = 0;
  int threads = 1;
  DecisionCounts decisions;
  StepCounts steps;          ///< under forces
  EnergyError energy_error;  ///< under forces: the largest of a particle, or of all of an orbit
                             ///< that interact
  std::vector<std::pair<std::uint64_t, std::string>>
      reports;  ///< of the first few particles that failed: index and report
};

template <>
struct Fields<SectionResult> {
  using R = SectionResult;
  static constexpr std::tuple list{
      field("orbits", "1", "Trajectories followed to their end", &R::orbits),
      field("points", "1", "Points of all orbits", &R::points),
      field("collisions", "1", "Reflections of all orbits", &R::collisions),
      field("incomplete", "1", "Particles with fewer points than requested", &R::incomplete),
      field("digest", "1", "Sum of a hash of each orbit's points: equal digests mean equal bits",
            &R::digest)};
};

/// How many trajectories System::section asks for.
std::uint64_t section_orbits(const System&);

/// Follows trajectories 0 … section_orbits - 1 until each has its points, or until t_max. The same
/// points on any number of threads.
SectionResult run_section(const System&, const SectionOptions& = {});

/// A section as its archive holds it; times, decisions and steps are not among it.
struct StoredSection {
  std::string system_name, system_toml, engine;
  SectionResult result;
  std::vector<SectionPoint> points;
};
/// Throws InputError for anything but the archive of a section.
StoredSection read_section(const std::string& file);

/// The points of a section, orbit after orbit; written aside, and renamed when finished.
class SectionArchive {
 public:
  SectionArchive(const std::string& file, const LoadedSystem&, const Provenance&, bool force,
                 ArchiveLock = nullptr);
  SectionArchive(const SectionArchive&) = delete;
  ~SectionArchive();

  void append(const std::vector<SectionPoint>&);
  void finish(const SectionResult&, const std::string& status);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace carom
