// What the result of an escape run holds.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "carom/analyses/escape.hpp"
#include "carom/table/hole_names.hpp"
#include "results/describe_ends.hpp"

namespace carom::analyses {

void describe_gone(auto& v, auto& c) {
  v.group("survival", "Fraction of the non-singular trajectories still inside");
  v.rows([&] { return survival(c); });
  v.kept_column({"gone", "1", "Trajectories that left after the previous time and by t"}, c.gone_in,
                c.times.size());
  v.group("escape_times", "Trajectories that left, in fine bins of time, 64 to a factor of two");
  v.bins({"from", "time", "Start of the bin, included; it ends where the next one starts"},
         {"gone", "1", "Trajectories that left in it"}, c.gone_at);
  v.group("escape_hits", "Trajectories that left, in fine bins of hits, 64 to a factor of two");
  v.bins({"from", "1",
          "Start of the bin, included, in hits minus one; it ends where the next one starts"},
         {"gone", "1", "Trajectories that left in it"}, c.gone_after);
  v.group("survival_hits", "Fraction of the non-singular trajectories still inside after n hits");
  v.rows([&] { return survival_by_hits(c); });
  v.first_rows({"gone", "1",
                "Trajectories that left after more hits than the previous number and at most n"},
               c.gone_in_hits, [&] { return survival_by_hits(c).size(); });
  v.group("rate", "Escape rate: -dP/dt averaged over (from, to]");
  v.rows([&] { return escape_rate(c); });
}

// Bins of each replicate, one replicate after the other.
template <class V, class Counts>
void describe_replicates(V& v, Counts& c) {
  if (!v.group_if(!c.parts.empty(), "replicates",
                  "Trajectories that left, in rows by replicate of quasi-random starts"))
    return;
  if constexpr (V::reads) c.parts.assign(replicates, {c, 0});
  const auto table = [&](const Label& label, std::size_t each, auto at) {
    std::vector<std::uint64_t> all;
    for (auto& part : c.parts) {
      const auto bins = at(part);
      all.insert(all.end(), bins.begin(), bins.end());
    }
    v.kept_column(label, all, each * c.parts.size());
    if constexpr (V::reads)
      for (std::size_t r = 0; r < c.parts.size(); ++r)
        std::copy_n(all.begin() + static_cast<std::ptrdiff_t>(r * each), each,
                    at(c.parts[r]).begin());
  };
  table({"followed", "1", "Trajectories whose fate is known"}, 1,
        [](auto& part) { return std::span(&part.followed, 1); });
  table({"gone", "1", "As /survival/gone"}, c.gone_in.size(),
        [](auto& part) { return std::span(part.gone_in); });
  table({"gone_hits", "1", "By numbers of hits: 0, 1, 2, 3, 5, 10, 20 ..."}, c.gone_in_hits.size(),
        [](auto& part) { return std::span(part.gone_in_hits); });
  table({"holes", "1", "As /fates/holes"}, c.hole_escapes.size(),
        [](auto& part) { return std::span(part.hole_escapes); });
}

template <class V, results::OrConst<EscapeResult> Result>
void describe(V& v, Result& result, const System& system) {
  auto& c = result.counts;
  if constexpr (V::reads) c = SurvivalCounts(v.template values<double>("survival", "t"), 0);
  v.group("fates", "Numbers of trajectories by fate");
  v.number({"trajectories", "1", "All trajectories"}, c.trajectories);
  v.fates(c, c.trajectories);
  results::describe_numbers<EndCounts>(v, c, system);
  results::describe_numbers<SurvivalNumbers>(v, c, system);
  results::describe_integration(v, result, system);
  v.number({"digest", "1",
            "Sum of a hash of each trajectory's end: different ends give a different digest"},
           result.digest);
  v.named_column({"holes", "1", "Escapes by hole; names in the attribute `names`"}, c.hole_escapes,
                 [&] { return hole_names(*system.table); });
  describe_gone(v, c);
  describe_replicates(v, c);
  v.provenance(result.effort);
}

}  // namespace carom::analyses
