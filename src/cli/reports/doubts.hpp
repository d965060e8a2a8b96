// Why a result cannot be trusted, which a report says before all else; what integration has cost;
// and last what was checked and what was not.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "carom/analyses/run.hpp"
#include "carom/analyses/section.hpp"
#include "carom/events/step_counts.hpp"
#include "carom/results/ensemble_result.hpp"
#include "carom/system/system.hpp"
#include "files/json.hpp"

namespace carom::cli {

/// Trajectories that failed, and energies that changed by more than integrator.energy_tolerance; a
/// line each.
struct Doubts {
  std::vector<std::string> lines;
  std::uint64_t failed = 0;  ///< unresolved and lost ones
  bool any() const { return !lines.empty(); }
  std::string text() const;
  std::string folded_text() const;  ///< in lines that fit
  /// The exit status of the command; `complete`: it was not interrupted.
  int status(bool complete) const;
};
/// Of `all` that were followed, each of them `what`: "trajectory", "particle".
Doubts doubts_of(const System&, std::uint64_t all, const char* what, const FateCounts&,
                 const Reports&, const EnergyError&);
Doubts doubts_of(const System&, const SectionResult&);
Doubts doubts_of(const System&, const SingleRunResult&);
/// That this many trajectories failed.
Doubts doubts_of_failures(std::uint64_t unresolved, std::uint64_t lost);
/// "" or what is said of the energy.
std::string energy_doubt(const System&, const EnergyError&);

/// Fates as text, "3 escaped, 1 lost: …"; "" if no particle ended so.
std::string fates_text(const FateCounts&);
/// `reports` of those that failed, if there are any: index, reason, and state in hexadecimal
/// numbers.
void add_reports(files::Json&, const Reports&);
/// `reason` and `state` of a report.
void add_report(files::Json&, const std::string& report);
/// Prints to standard error why some of `all` that failed did: the first reasons, each with the
/// state of one, and how many more there are.
void warn_of(const Reports&, std::uint64_t all);
/// Of the particles of one run.
void warn_of(const SingleRunResult&);

/// Keys of integrated motion: `steps`, `force_evaluations`, and with unresolved = "count"
/// `unresolved_steps` and `first_unresolved`.
void add_steps(files::Json&, const System&, const StepCounts&);
/// The same as a text that goes on a sentence: "1 200 steps, 13 200 force evaluations"; "" where
/// nothing is integrated.
std::string steps_text(const System&, const StepCounts&);
/// What happened to the particles of an ensemble.
struct EventCounts {
  std::uint64_t hits = 0, contacts = 0;
  std::uint64_t all() const { return hits + contacts; }
};
/// "1.2M hits/s", of discs hits and contacts, or steps where nothing hits.
std::string pace_text(const System&, const EventCounts&, const StepCounts&, double seconds);
/// "largest change of a trajectory's energy …: 1e-12 at the end …\n"; "" where nothing is
/// integrated.
std::string energy_text(const System&, const EnergyError&);

/// "checked: …; not: …", in lines that fit.
std::string grounds_text(const std::string& checked, const std::string& unchecked);
/// Of an ensemble; `errors`: it has standard errors or intervals, whose coverage was tried.
std::string grounds_text(const System&, const StepCounts&, bool errors);

}  // namespace carom::cli
