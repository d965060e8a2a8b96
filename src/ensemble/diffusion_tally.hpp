// How a trajectory is added to the result of a diffusion run.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "carom/ensemble/diffusion.hpp"
#include "carom/events/report.hpp"
#include "ensemble/energy_watch.hpp"
#include "ensemble/ensemble_run.hpp"
#include "ensemble/first_reports.hpp"
#include "ensemble/particle_hash.hpp"

namespace carom {

/// A particle of a trajectory: its number, how and when it ended, its state after the last event, and |r - r(0)|^2 at the report
/// times it reached.
struct DiffusingParticle {
  std::uint64_t number = 0;
  Fate fate = Fate::survived;
  double time = 0.0;
  std::uint64_t hits = 0;
  int last_wall = -1;
  State state;
  const std::vector<double>* squares = nullptr;
  std::string report;
  std::size_t samples = 0;  ///< of the squares, those that count
};

/// Adds whole trajectories to what a thread of the run has done.
class DiffusionTally {
 public:
  using Thread = EnsembleRun<DiffusionResult>::Thread;
  DiffusionTally(Thread& thread, const System& system) : thread_(thread), hash_(system) {}

  bool stopped() const { return thread_.stopped(); }

  void add(std::uint64_t trajectory, const std::vector<DiffusingParticle>& particles, const EnergiesSeen& energies,
           const StepCounts& steps, const DecisionCounts& decisions) {
    std::uint64_t hits = 0;
    const TrajectoryRange range{trajectory, trajectory + 1};
    thread_.deliver(range, [&](DiffusionResult& sum) {
      for (const DiffusingParticle& particle : particles) {
        const DiffusingParticle p = held_by_numbers(particle, sum.sums.times());
        add_to(sum, trajectory, p);
        hits += p.hits;
      }
      sum.energy_change = larger(sum.energy_change, energies.change);
      sum.energy_error += energies.error;
      sum.steps += steps;
      sum.decisions += decisions;
      sum.done.add(range);
    });
    thread_.report(1, hits);
  }

 private:
  /// A particle so far away that |r - r(0)|^4 is no number ends there as unresolved.
  static DiffusingParticle held_by_numbers(DiffusingParticle p, const std::vector<double>& times) {
    const std::vector<double>& squares = *p.squares;
    const auto beyond = std::find_if(squares.begin(), squares.end(), [](double s) { return !std::isfinite(s * s); });
    p.samples = static_cast<std::size_t>(beyond - squares.begin());
    if (beyond == squares.end()) return p;
    p.fate = Fate::unresolved;
    p.time = times[p.samples];
    p.report = report_of({}, p.state, p.fate, "it is so far away that |r - r(0)|^4 is not a number");
    return p;
  }
  void add_to(DiffusionResult& sum, std::uint64_t trajectory, const DiffusingParticle& p) const {
    count(sum, p.fate);
    for (std::size_t k = 0; k < p.samples; ++k) sum.sums.add(trajectory, k, (*p.squares)[k]);
    sum.collisions += p.hits;
    sum.digest += hash_(p.number, p.fate, p.time, p.hits, p.last_wall, p.state, std::span(*p.squares).first(p.samples));
    if (is_failure(p.fate)) keep_first(sum.reports, p.number, p.report);
  }
  static void count(DiffusionResult& sum, Fate fate) {
    ++sum.trajectories;
    switch (fate) {
      case Fate::survived: ++sum.survived; break;
      case Fate::pinned: ++sum.survived, ++sum.pinned; break;
      case Fate::capped: ++sum.capped; break;
      case Fate::escaped: ++sum.escaped; break;
      case Fate::singular: ++sum.singular; break;
      case Fate::unbounded: ++sum.unbounded; break;
      case Fate::unresolved: ++sum.unresolved; break;
      case Fate::lost: ++sum.lost; break;
    }
  }

  Thread& thread_;
  ParticleHash hash_;
};

}  // namespace carom
