// What the result of a run of returns holds.
#pragma once

#include <cstddef>
#include <vector>

#include "carom/analyses/returns.hpp"
#include "results/describe_counts.hpp"
#include "results/describe_ends.hpp"

namespace carom::analyses {

template <class V, results::OrConst<ReturnsResult> Result>
void describe(V& v, Result& result, const System& system) {
  v.group("fates", "Numbers of particles by their end");
  results::describe_ends(v, result, system);
  v.group("return_times", "Times from one hit of the wall to the next");
  v.rows([&] {
    std::vector<ReturnTimeBin> rows;
    for (const auto& bin : returns_of(result.sums, system.run.t_max / 2).times.bins)
      rows.push_back({bin});
    return rows;
  });
  v.group("return_hits", "Hits from one hit of the wall to the next, which is included");
  v.rows([&] {
    std::vector<ReturnHitsBin> rows;
    for (const auto& bin : returns_of(result.sums, system.run.t_max / 2).hits.bins)
      rows.push_back({bin});
    return rows;
  });
  v.group("return_groups", "Counts by group of trajectories (index modulo 128)");
  std::vector<ReturnSums::Sum> read(V::reads ? ReturnSums::groups : 0);
  const auto of = [&](std::size_t g) -> decltype(auto) {
    if constexpr (V::reads)
      return (read[g]);
    else
      return result.sums.of(g);
  };
  const auto each = [&](const Label& label, auto get) {
    v.kept_each(label, ReturnSums::groups, get);
  };
  each(
      {"particles", "1", "Particles of each group that were followed to the end"},
      [&](std::size_t g) -> auto& { return of(g).particles; });
  each(
      {"hits", "1", "Hits of all walls in the first half of the run"}, [&](std::size_t g) -> auto& {
        return of(g).hits_in_half;
      });
  each(
      {"fewest_away", "1", "Fewest hits of an unfinished excursion; 2^64 - 1: none"},
      [&](std::size_t g) -> auto& { return of(g).fewest_away; });
  const char *const counted = "Returns of the group in this bin",
                    *const longer = "Excursions of half of the run or more, of each group",
                    *const away = "Unfinished excursions, of each group";
  results::describe_counts(
      v, "time_", {"time", counted, longer},
      ReturnSums::groups, [&](std::size_t g) -> auto& { return of(g).times; });
  results::describe_counts(
      v, "hits_", {"1", counted, away},
      ReturnSums::groups, [&](std::size_t g) -> auto& { return of(g).hits; });
  if constexpr (V::reads)
    for (std::size_t g = 0; g < read.size(); ++g) result.sums.add(g, read[g]);
}

}  // namespace carom::analyses
