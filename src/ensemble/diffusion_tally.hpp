// What threads add up in a diffusion run.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "carom/base/digest.hpp"
#include "carom/ensemble/diffusion.hpp"

namespace carom {

struct DiffusionTally {
  static constexpr std::size_t most_reports = 5;

  explicit DiffusionTally(const System& system) { sums = DisplacementSums(system.run.times); }

  /// A particle's trajectory: its number, how and when it ended, and |r - r(0)|^2 at the report times it
  /// reached.
  struct Trajectory {
    std::uint64_t trajectory = 0, number = 0;
    Fate fate = Fate::survived;
    double time = 0.0;
    std::uint64_t hits = 0;
    int last_wall = -1;
  };
  void add(const Trajectory& t, const std::vector<double>& squares, const std::string& report) {
    count(t.fate);
    for (std::size_t k = 0; k < squares.size(); ++k) sums.add(t.trajectory, k, squares[k]);
    result.collisions += t.hits;
    result.digest +=
        trajectory_hash(t.number, static_cast<std::uint64_t>(t.fate), t.time, t.hits, t.last_wall);
    if (t.fate == Fate::lost && reports.size() < most_reports) reports.emplace_back(t.number, report);
  }
  void change_of_energy(double change) { result.energy_change = std::max(result.energy_change, change); }

  void merge(const DiffusionTally& other) {
    sums.merge(other.sums);
    const DiffusionResult& r = other.result;
    result.trajectories += r.trajectories;
    result.survived += r.survived;
    result.pinned += r.pinned;
    result.escaped += r.escaped;
    result.singular += r.singular;
    result.unbounded += r.unbounded;
    result.capped += r.capped;
    result.lost += r.lost;
    result.collisions += r.collisions;
    result.energy_change = std::max(result.energy_change, r.energy_change);
    result.digest += r.digest;
    result.decisions += r.decisions;
    reports.insert(reports.end(), other.reports.begin(), other.reports.end());
    std::sort(reports.begin(), reports.end());
    if (reports.size() > most_reports) reports.resize(most_reports);
  }

  DisplacementSums sums;
  DiffusionResult result;  ///< its counts alone
  std::vector<std::pair<std::uint64_t, std::string>> reports;

 private:
  void count(Fate fate) {
    ++result.trajectories;
    switch (fate) {
      case Fate::survived:
        ++result.survived;
        break;
      case Fate::pinned:
        ++result.survived, ++result.pinned;
        break;
      case Fate::capped:
        ++result.capped;
        break;
      case Fate::escaped:
        ++result.escaped;
        break;
      case Fate::singular:
        ++result.singular;
        break;
      case Fate::unbounded:
        ++result.unbounded;
        break;
      case Fate::lost:
        ++result.lost;
        break;
    }
  }
};

}  // namespace carom
