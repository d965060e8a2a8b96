// The numbers of a comparison's archive, where writing and reading meet.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "carom/ensemble/compare.hpp"
#include "io/archive/hdf5.hpp"

namespace carom::io {

/// A number of a row.
template <class Row, class T>
struct Entry {
  const char* name;
  T Row::*value;
  hdf5::Description description;
};

/// A run, with the index of its scheme and of its failure (0: none).
struct StoredRunRow : ComparedRun {
  std::int64_t scheme = 0, failed_by = 0, all_same = 0;
};
/// A scheme. What is not known is not a number, or -1.
struct StoredSchemeRow {
  std::int64_t order = 0, adaptive = 0, steps = 0, reversible = -1;
  double measured = 0.0, measured_error = 0.0, from = 0.0, to = 0.0;
  double areas = 0.0, areas_error = 0.0, areas_step = 0.0;
  double work_step = 0.0, work_tolerance = 0.0, work_evaluations = 0.0, work_cpu = 0.0;
};

inline constexpr Entry<Comparison, double> comparison_numbers[] = {
    {"t", &Comparison::t, {"time", "Time of the comparison"}},
    {"growth", &Comparison::growth, {"1", "Growth of small distances until then"}},
    {"size", &Comparison::size, {"length", "Unit of error_state for positions"}},
    {"speed", &Comparison::speed, {"length/time", "Unit of error_state for velocities"}},
    {"error", &Comparison::error, {"1", "Error of the state that is wanted"}},
    {"reference_step", &Comparison::reference_step, {"time", "Step of the reference; 0: none"}},
    {"reference_error", &Comparison::reference_error, {"1", "Error of the reference's state"}},
    {"longest_resolved",
     &Comparison::longest_resolved,
     {"time", "Longest step that resolves the forces, of those tried; 0: no forces"}},
    {"seconds", &Comparison::seconds, {"s", "Wall time"}},
    {"cpu_seconds", &Comparison::cpu_seconds, {"s", "CPU time"}},
};

using RunRow = StoredRunRow;
inline constexpr Entry<RunRow, double> run_numbers[] = {
    {"step", &RunRow::step, {"time", "Step; 0: adaptive"}},
    {"tolerance", &RunRow::tolerance, {"1", "Tolerance; 0: fixed steps"}},
    {"error_state",
     &RunRow::error_state,
     {"1", "Larger one of error_position/size and error_velocity/speed"}},
    {"error_position", &RunRow::error_position, {"length", "Largest error of a position"}},
    {"error_velocity", &RunRow::error_velocity, {"length/time", "Largest error of a velocity"}},
    {"error_energy",
     &RunRow::error_energy,
     {"1", "Largest change of the energy over the largest kinetic energy"}},
    {"energy_trend", &RunRow::energy_trend, {"1/time", "Trend of that change"}},
    {"energy_trend_stderr", &RunRow::trend_error, {"1/time", "Its standard error"}},
    {"error_hit_time", &RunRow::error_hit_time, {"time", "Largest error of a hit's time"}},
    {"error_hit_place", &RunRow::error_hit_place, {"length", "Largest error of a hit's place"}},
    {"error_reversal",
     &RunRow::error_reversal,
     {"1", "Error of the start, there and back, in units of error_state"}},
    {"rounding", &RunRow::rounding, {"1", "What rounding may have made of error_state"}},
    {"cpu_seconds", &RunRow::cpu_seconds, {"s", "CPU time, the least of several runs"}},
};
inline constexpr Entry<RunRow, std::uint64_t> run_counts[] = {
    {"hits", &RunRow::hits, {"1", "Hits in common with the reference, from the first on"}},
    {"steps", &RunRow::steps, {"1", "Steps and parts of steps"}},
    {"force_evaluations", &RunRow::force_evaluations, {"1", "Evaluations of the forces"}},
    {"unresolved_steps",
     &RunRow::unresolved,
     {"1", "Steps that do not resolve the forces, which were counted"}},
};
inline constexpr Entry<RunRow, std::int64_t> run_indices[] = {
    {"scheme", &RunRow::scheme, {"1", "Index into the attribute `names`"}},
    {"same_hits", &RunRow::all_same, {"1", "1: all hits are those of the reference"}},
    {"failure", &RunRow::failed_by, {"1", "Index into the attribute `names`; 0: none"}},
};

using SchemeRow = StoredSchemeRow;
inline constexpr Entry<SchemeRow, double> scheme_numbers[] = {
    {"measured", &SchemeRow::measured, {"1", "Measured order"}},
    {"measured_error", &SchemeRow::measured_error, {"1", "Its error"}},
    {"from", &SchemeRow::from, {"time", "Longest step that it rests on"}},
    {"to", &SchemeRow::to, {"time", "Shortest step that it rests on"}},
    {"areas", &SchemeRow::areas, {"1", "Largest defect of phase-space areas in a step"}},
    {"areas_error", &SchemeRow::areas_error, {"1", "Error of the differences it is taken from"}},
    {"areas_step", &SchemeRow::areas_step, {"time", "That step"}},
    {"work_step", &SchemeRow::work_step, {"time", "Step for the wanted error"}},
    {"work_tolerance", &SchemeRow::work_tolerance, {"1", "Tolerance for the wanted error"}},
    {"work_evaluations",
     &SchemeRow::work_evaluations,
     {"1", "Evaluations of the forces for the wanted error"}},
    {"work_cpu_seconds", &SchemeRow::work_cpu, {"s", "CPU time for the wanted error"}},
};
inline constexpr Entry<SchemeRow, std::int64_t> scheme_indices[] = {
    {"order", &SchemeRow::order, {"1", "Stated order; 0: varies"}},
    {"adaptive", &SchemeRow::adaptive, {"1", "1: a tolerance in place of a step"}},
    {"steps", &SchemeRow::steps, {"1", "Number of steps that the order rests on"}},
    {"reversible", &SchemeRow::reversible, {"1", "1: reversible; -1: not known"}},
};

}  // namespace carom::io
