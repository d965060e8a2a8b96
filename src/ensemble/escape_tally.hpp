// What a block of an escape ensemble adds up.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "carom/ensemble/escape.hpp"
#include "carom/table/hole_names.hpp"
#include "ensemble/energy_watch.hpp"
#include "ensemble/first_reports.hpp"
#include "ensemble/particle_hash.hpp"

namespace carom {

/// Where a particle starts, in the plane: a lattice's state lies in a cell.
inline TrajectoryRecord start_of(const Table& table, const State& state) {
  TrajectoryRecord record;
  geometry::Vector position = state.position;
  if (table.lattice) position = position + table.lattice->translation(state.cell);
  record.x = position.x;
  record.y = position.y;
  record.vx = state.velocity.x;
  record.vy = state.velocity.y;
  return record;
}

struct EscapeTally {
  SurvivalCounts counts;
  std::uint64_t digest = 0;
  StepCounts steps;
  EnergiesSeen energies;
  std::vector<std::pair<std::uint64_t, std::string>> reports;  // of the first by index

  explicit EscapeTally(const System& system)
      : counts(system.run.times, hole_names(*system.table).size()), hash_(system) {}

  /// The end of one particle; record.time is t_max for survivors, `state` that after its last event.
  void add(const TrajectoryRecord& end, int last_wall, const State& state, const std::string& report) {
    counts.add(end.fate, end.time, end.hits, end.hole);
    digest += hash_(end.index, end.fate, end.time, end.hits, last_wall, state);
    if (is_failure(end.fate)) keep_first(reports, end.index, report);
  }

 private:
  ParticleHash hash_;
};

}  // namespace carom
