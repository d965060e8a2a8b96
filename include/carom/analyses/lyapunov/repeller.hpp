// The Lyapunov exponent of the orbits that never leave an open table, from populations that are
// kept alive by splitting.
#pragma once

#include <cstdint>
#include <optional>

#include "carom/analyses/splitting.hpp"
#include "carom/results/estimate.hpp"

namespace carom {

/// What populations say of the repeller, by its natural measure (docs/physics/lyapunov.md).
struct RepellerExponent {
  Extrapolated per_time, per_hit;
  /// per_time in the first and in the second half of the window, and their difference.
  Extrapolated early, late, change;
  std::uint64_t population = 0;        ///< trajectories of each
  std::uint64_t hits_from = 0;         ///< where the window begins
  std::uint64_t hits = 0;              ///< where it ends: so long populations were kept
  double time_from = 0.0, time = 0.0;  ///< the mean times of both
  double kick = 0.0;                   ///< the largest
  Mean kick_cost;                      ///< as cost_of_kicks, at the last level
  double trapped = 0.0;                ///< share of the starts that can never leave

  /// Standard error, extrapolation included.
  Estimate estimate() const;
  /// Do the halves of the window differ by more than chance and kicks explain?
  bool drifts() const;
  bool kicks_cost() const { return is_certain(kick_cost, per_time.repetitions); }
};

/// But for the quantities that are extrapolated.
template <>
struct Fields<RepellerExponent> {
  using R = RepellerExponent;
  static constexpr std::tuple list{
      field("kick", "1", "The largest kick of copies, of v_parallel / v", &R::kick),
      field_as<double>(
          "kick_cost", "1", "Relative change of survival caused by the kicks",
          [](auto& r) -> auto& { return r.kick_cost.value; }),
      field_as<double>(
          "kick_cost_stderr", "1", "Its standard error",
          [](auto& r) -> auto& { return r.kick_cost.error; }),
      field("time_from", "time", "Mean time at the start of the window", &R::time_from),
      field("time_to", "time", "Mean time at its end", &R::time),
      field("trapped", "1", "Fraction of the starts that can never leave", &R::trapped),
      field("population", "1", "Trajectories of each population", &R::population),
      field("hits_from", "1", "Hits at the start of the window", &R::hits_from),
      field("hits_to", "1", "Hits at its end", &R::hits),
      field_as<std::uint64_t>(
          "repetitions", "1", "Independent populations at each of three kicks",
          [](auto& r) -> auto& { return r.per_time.repetitions; })};
};

/// Is this system of a free particle, and can it leave?
bool is_open(const System&);
/// How many trajectories populations take at least.
std::uint64_t least_of_repeller();

/// Keeps populations of run.trajectories in all, at most 20 000 each, until `window.to`; their
/// growth counts from `window.from` on. Empty: it was interrupted. Throws InputError where no
/// trajectory stays long enough.
std::optional<RepellerExponent> measure_repeller(const System&, TimeWindow window,
                                                 double unit_length, const SplittingOptions& = {});

}  // namespace carom
