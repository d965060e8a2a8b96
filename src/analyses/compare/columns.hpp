// The numbers of a comparison's archive, where writing and reading meet.
#pragma once

#include <cstdint>

#include "carom/analyses/compare.hpp"

namespace carom::analyses {

/// A run, with the index of its scheme and of its failure (0: none).
struct StoredRunRow : ComparedRun {
  std::int64_t scheme = 0, failed_by = 0, all_same = 0;
};
/// A scheme. What is not known is not a number, or -1.
struct StoredSchemeRow {
  std::int64_t order = 0, adaptive = 0, steps = 0, reversible = -1, reason = 0;
  double measured = 0.0, measured_error = 0.0, from = 0.0, to = 0.0;
  double areas = 0.0, areas_error = 0.0, areas_step = 0.0;
  double work_step = 0.0, work_tolerance = 0.0, work_evaluations = 0.0, work_cpu = 0.0;
};
}  // namespace carom::analyses

namespace carom {

template <>
struct Fields<Comparison> {
  static constexpr std::tuple list{
      field("t", "time", "Time of the comparison", &Comparison::t),
      field("growth", "1", "Growth of small distances until then", &Comparison::growth),
      field("size", "length", "Unit of error_state for positions", &Comparison::size),
      field("speed", "length/time", "Unit of error_state for velocities", &Comparison::speed),
      field("error", "1", "Wanted error of the state", &Comparison::error),
      field("reference_step", "time", "Step of the reference; 0: none",
            &Comparison::reference_step),
      field("reference_error", "1", "Error of the reference's state", &Comparison::reference_error),
      field("longest_resolved", "time",
            "Longest step that resolves the forces, of those tried; 0: no forces",
            &Comparison::longest_resolved),
      field("seconds", "s", "Wall time", &Comparison::seconds),
      field("cpu_seconds", "s", "CPU time", &Comparison::cpu_seconds),
      field("hits", "1", "Hits of the reference", &Comparison::hits)};
};
template <>
struct Fields<ComparedEnd> {
  static constexpr std::tuple list{
      field("x", "length", "Position of the reference at the end", &ComparedEnd::x),
      field("y", "length", "Position of the reference at the end", &ComparedEnd::y),
      field("vx", "length/time", "Velocity of the reference at the end", &ComparedEnd::vx),
      field("vy", "length/time", "Velocity of the reference at the end", &ComparedEnd::vy)};
};
template <>
struct Fields<analyses::StoredRunRow> {
  using RunRow = analyses::StoredRunRow;
  static constexpr std::tuple list{
      field("step", "time", "Step; 0: adaptive", &RunRow::step),
      field("tolerance", "1", "Tolerance; 0: fixed steps", &RunRow::tolerance),
      field("error_state", "1", "Larger of error_position/size and error_velocity/speed",
            &RunRow::error_state),
      field("error_position", "length", "Largest error of a position", &RunRow::error_position),
      field("error_velocity", "length/time", "Largest error of a velocity",
            &RunRow::error_velocity),
      field("error_energy", "1", "Largest change of the energy over the largest kinetic energy",
            &RunRow::error_energy),
      field("energy_trend", "1/time", "Trend of that change", &RunRow::energy_trend),
      field("energy_trend_stderr", "1/time", "Its standard error", &RunRow::trend_error),
      field("error_hit_time", "time", "Largest error of a hit's time", &RunRow::error_hit_time),
      field("error_hit_place", "length", "Largest error of a hit's position",
            &RunRow::error_hit_place),
      field("error_reversal", "1",
            "Error of the start after integrating forth and back, in units of error_state",
            &RunRow::error_reversal),
      field("rounding", "1", "Part of error_state that may be rounding", &RunRow::rounding),
      field("cpu_seconds", "s", "CPU time, the least of several runs", &RunRow::cpu_seconds),
      field("hits", "1", "Hits in common with the reference, before the first difference",
            &RunRow::hits),
      field("steps", "1", "Steps and parts of steps", &RunRow::steps),
      field("force_evaluations", "1", "Evaluations of the forces", &RunRow::force_evaluations),
      field("unresolved_steps", "1", "Steps that do not resolve the forces", &RunRow::unresolved),
      field("scheme", "1", "Index into the attribute `names`", &RunRow::scheme),
      field("same_hits", "1", "1: all hits are those of the reference", &RunRow::all_same),
      field("failure", "1", "Index into the attribute `names`; 0: none", &RunRow::failed_by)};
};
template <>
struct Fields<analyses::StoredSchemeRow> {
  using SchemeRow = analyses::StoredSchemeRow;
  static constexpr std::tuple list{
      field("measured", "1", "Measured order", &SchemeRow::measured),
      field("measured_error", "1", "Its error", &SchemeRow::measured_error),
      field("from", "time", "Longest step used for it", &SchemeRow::from),
      field("to", "time", "Shortest step used for it", &SchemeRow::to),
      field("areas", "1", "Largest defect of phase-space areas in a step", &SchemeRow::areas),
      field("areas_error", "1", "Error of the finite differences", &SchemeRow::areas_error),
      field("areas_step", "time", "That step", &SchemeRow::areas_step),
      field("work_step", "time", "Step for the wanted error", &SchemeRow::work_step),
      field("work_tolerance", "1", "Tolerance for the wanted error", &SchemeRow::work_tolerance),
      field("work_evaluations", "1", "Evaluations of the forces for the wanted error",
            &SchemeRow::work_evaluations),
      field("work_cpu_seconds", "s", "CPU time for the wanted error", &SchemeRow::work_cpu),
      field("order", "1", "Stated order; 0: varies", &SchemeRow::order),
      field("adaptive", "1", "1: a tolerance in place of a step", &SchemeRow::adaptive),
      field("steps", "1", "Number of steps used for the order", &SchemeRow::steps),
      field("reversible", "1", "1: reversible; -1: not known", &SchemeRow::reversible),
      field("reason", "1",
            "Why no order was measured: index into the attribute `names`; 0: measured",
            &SchemeRow::reason)};
};

}  // namespace carom
