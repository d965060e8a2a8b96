// What the result of a diffusion run holds.
#pragma once

#include <cstddef>
#include <vector>

#include "carom/analyses/diffusion.hpp"
#include "results/describe_counts.hpp"
#include "results/describe_ends.hpp"

namespace carom::analyses {

// Group by group, for errors of whatever is computed from the moments.
template <class V, class Sums>
void describe_moments(V& v, Sums& sums, const System& system) {
  v.group("msd", "Moments of the displacement in the plane since t = 0");
  v.kept_rows([&] { return DisplacementMoments(sums, system.particles.size()).points(); });
  if constexpr (V::reads) sums = DisplacementSums(v.template values<double>("msd", "t"));
  v.group("msd_groups",
          "Sums by group of trajectories (index modulo 128): row group * times + time");
  const std::size_t times = sums.times().size(), count = DisplacementSums::groups * times;
  std::vector<DisplacementSums::Sum> read(V::reads ? count : 0);
  const auto row = [&](std::size_t i) -> decltype(auto) {
    if constexpr (V::reads)
      return (read[i]);
    else
      return sums.of(i / times, i % times);
  };
  v.kept_each(
      {"count", "1", "Particles still inside at t"},
      count, [&](std::size_t i) -> auto& { return row(i).count; });
  v.computed({"square", "length^2", "Sum of their squared displacements"}, [&] {
    std::vector<double> rounded;
    for (std::size_t i = 0; i < count; ++i) rounded.push_back(row(i).square.value());
    return rounded;
  });
  v.sums(
      {"square_digits", "length^2",
       "The same as exact sums: in each row `digits` numbers, the i-th of them times 2^(32 (first "
       "+ i) - 1074)"},
      count, [&](std::size_t i) -> auto& { return row(i).square; });
  v.sums(
      {"fourth_digits", "length^4",
       "Sum of the fourth powers of their displacements, in the same form"},
      count, [&](std::size_t i) -> auto& { return row(i).fourth; });
  v.sums(
      {"velocities_digits", "length^2/time^2", "Sum of v(t).v(0), in the same form"},
      count, [&](std::size_t i) -> auto& { return row(i).velocities; });
  v.sums(
      {"along_digits", "length^2/time", "Sum of v(0).(r(t) - r(0)), in the same form"},
      count, [&](std::size_t i) -> auto& { return row(i).along; });
  if constexpr (V::reads)
    for (std::size_t i = 0; i < count; ++i) sums.merge(i / times, i % times, read[i]);
}

template <class V, class Sums>
void describe_free_paths(V& v, Sums& sums) {
  if (v.group_if(sums.counted(), "free_paths", "Lengths of flights from one hit to the next"))
    v.kept_rows([&] { return free_paths_of(sums).between.bins; });
  if (v.group_if(sums.counted(), "free_paths_at_start", "Lengths of flights from the start"))
    v.kept_rows([&] { return free_paths_of(sums).at_start.bins; });
  if (!v.group_if(sums.counted(), "free_path_groups",
                  "The same by group of trajectories (index modulo 128)"))
    return;
  double limit = sums.limit();
  v.kept({"limit", "length", "Flights of this length or more are only counted as longer"}, limit);
  std::vector<FreePathSums::Sum> read(V::reads ? FreePathSums::groups : 0);
  const auto of = [&](std::size_t g) -> decltype(auto) {
    if constexpr (V::reads)
      return (read[g]);
    else
      return sums.of(g);
  };
  v.kept_each(
      {"hits", "1", "Hits of the particles of each group"},
      FreePathSums::groups, [&](std::size_t g) -> auto& { return of(g).hits; });
  v.sums(
      {"path_digits", "length",
       "Total length of their flights, as an exact sum: digits as in /msd_groups"},
      FreePathSums::groups, [&](std::size_t g) -> auto& { return of(g).path; });
  const results::CountLabels flights{"length", "Flights of the group in this bin",
                                     "Flights of each group beyond the limit"};
  results::describe_counts(
      v, "", flights, FreePathSums::groups, [&](std::size_t g) -> auto& { return of(g).between; });
  results::describe_counts(
      v, "start_", flights,
      FreePathSums::groups, [&](std::size_t g) -> auto& { return of(g).at_start; });
  if constexpr (V::reads) {
    sums = FreePathSums(limit);
    for (std::size_t g = 0; g < read.size(); ++g) sums.merge(g, read[g]);
  }
}

template <class V, results::OrConst<DiffusionResult> Result>
void describe(V& v, Result& result, const System& system) {
  v.group("fates", "Numbers of particles by their end before the last report time");
  results::describe_ends(v, result, system);
  v.kept({"energy_change", "energy", "With forces: the largest change of a trajectory's energy"},
         result.energy_change);
  describe_moments(v, result.sums, system);
  describe_free_paths(v, result.free_paths);
}

}  // namespace carom::analyses
