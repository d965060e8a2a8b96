// What the result of a Lyapunov run holds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "carom/analyses/lyapunov.hpp"
#include "results/describe_ends.hpp"

namespace carom::analyses {

// A quantity that populations measured.
void describe_extrapolated(auto& v, const std::string& key, const char* unit, const char* text,
                           auto& e) {
  const auto number = [&](const std::string& name, auto& value, const char* what) {
    v.kept({name.c_str(), unit, what}, value);
  };
  number(key, e.limit.value, text);
  number(key + "_stderr", e.limit.error, "Its standard error, from the repetitions");
  number(key + "_extrapolation", e.extrapolation,
         "Its distance from the value at the smallest kick");
  const std::string kicks = key + "_at_kicks", errors = kicks + "_stderr";
  v.kept_each(
      {kicks.c_str(), unit, "Its value at each kick"},
      kick_sizes, [&](std::size_t i) -> auto& { return e.at_kick[i].value; });
  v.kept_each(
      {errors.c_str(), unit, "Their standard errors"},
      kick_sizes, [&](std::size_t i) -> auto& { return e.at_kick[i].error; });
}

template <class V, class Repeller>
void describe_repeller(V& v, Repeller& repeller) {
  if (!v.group_if(repeller.has_value(), "repeller",
                  "Exponent of the orbits that never leave, from populations in which survivors "
                  "are copied"))
    return;
  if constexpr (V::reads) repeller.emplace();
  auto& r = *repeller;
  const auto quantity = [&](const char* key, const char* unit, const char* text, auto& value) {
    describe_extrapolated(v, key, unit, text, value);
  };
  quantity("lambda", "1/time", "Exponent of the orbits that never leave", r.per_time);
  quantity("per_collision", "1", "The same per hit", r.per_hit);
  quantity("early", "1/time", "Exponent in the first half of the window", r.early);
  quantity("late", "1/time", "Exponent in the second half", r.late);
  quantity("change", "1/time", "Their difference", r.change);
  v.kept_numbers(r);
  if constexpr (V::reads)
    for (Extrapolated* e : {&r.per_hit, &r.early, &r.late, &r.change})
      e->repetitions = r.per_time.repetitions;
}

// What the sums say: nothing of it is read.
void describe_estimates(auto& v, const LyapunovResult& result, const System& system) {
  const LyapunovEstimate e = estimate_of(system, result);
  const auto number = [&](const char* name, const char* unit, const char* text, double value) {
    v.computed({name, unit, text}, [&] { return value; });
  };
  number("lambda", "1/time", "Largest exponent, mean over orbits; NaN: the run is too short",
         e.per_time.value);
  number("lambda_stderr", "1/time", "Its standard error", e.per_time.error);
  number("per_collision", "1", "Largest exponent per hit", e.per_hit.value);
  number("per_collision_stderr", "1", "Its standard error", e.per_hit.error);
  number("chaotic_share", "1", "Fraction of the orbits that are chaotic; NaN: the run is too short",
         e.chaotic_share.value);
  number("chaotic_share_stderr", "1", "The larger side of its 95 % interval over 1.96",
         e.chaotic_share.error);
  number("chaotic_share_low", "1", "Start of its 95 % interval", e.share_interval.low);
  number("chaotic_share_high", "1", "Its end", e.share_interval.high);
  if (!result.spectrum.counted()) return;
  const SpectrumEstimate spectrum = estimate_of(result.spectrum);
  const auto column = [&](const char* name, const char* text, double Estimate::*part) {
    v.computed({name, "1/time", text}, [&] {
      std::vector<double> values;
      for (const Estimate& one : spectrum.exponents) values.push_back(one.*part);
      return values;
    });
  };
  column("spectrum", "All exponents, the largest first", &Estimate::value);
  column("spectrum_stderr", "Their standard errors", &Estimate::error);
  number("entropy", "1/time", "Entropy of Kolmogorov and Sinai", spectrum.entropy.value);
  number("entropy_stderr", "1/time", "Its standard error", spectrum.entropy.error);
}

template <class V, class Sums>
void describe_convergence(V& v, Sums& sums, const LyapunovResult& result) {
  if (!v.group_if(!sums.times().empty(), "convergence", "The exponent at growing times")) return;
  v.kept_rows([&] { return convergence_of(result); });
  if constexpr (V::reads) sums = ConvergenceSums(v.template values<double>("convergence", "t"));
  v.sums(
      {"sums", "1, 1", "Sums over orbits of ln|deviation| and of its square, a pair for each row"},
      2 * sums.sums().size(), [&](std::size_t i) -> auto& {
        auto& at = sums.sums()[i / 2];
        return i % 2 == 0 ? at.length : at.square;
      });
}

void describe_drift(auto& v, const char* name, auto& sums) {
  const std::string orbits = std::string(name) + "_orbits";
  if (!v.kept_if(sums.orbits > 0, {orbits.c_str(), "1", "Orbits of these sums"}, sums.orbits))
    return;
  v.sums(
      {name, "1/time, 1/time^2",
       "How much faster deviations grew than in T/4 to T: sums of x in T/64 to T/16, of y in "
       "T/16 to T/4, of x^2, y^2 and xy; digits as in totals"},
      5, [&](std::size_t i) -> auto& {
        const decltype(&sums.far) all[] = {&sums.far, &sums.near, &sums.far_squares,
                                           &sums.near_squares, &sums.product};
        return *all[i];
      });
}

// Of each exponent, and last of the entropy, the sums of its growth.
template <class V, class Sums>
void describe_spectrum(V& v, Sums& spectrum, const GrowthSums& like) {
  std::uint64_t zeros = spectrum.zeros();
  if (!v.kept_if(spectrum.counted(),
                 {"spectrum_zeros", "1", "Exponents that vanish by conservation laws"}, zeros))
    return;
  const std::size_t levels = like.totals().levels.size();
  std::size_t count = spectrum.sums().size();
  if constexpr (V::reads) count = v.template values<double>("lyapunov", "spectrum").size() + 1;
  std::vector<GrowthSums::Totals> all(count);
  for (std::size_t i = 0; i < count; ++i) {
    if constexpr (V::reads) {
      all[i].orbits = all[i].linear = like.totals().orbits;
      all[i].levels.resize(levels);
    } else {
      all[i] = spectrum.sums()[i].totals();
    }
  }
  v.sums(
      {"spectrum_totals", "1",
       "Growth of each length of the frame, and of the entropy; digits as in totals"},
      count, [&](std::size_t i) -> auto& { return all[i].growth; });
  v.sums(
      {"spectrum_squares", "1",
       "Their growth^2 over groups of 1, 2, 4 ... blocks; digits as in totals"},
      count * levels, [&](std::size_t i) -> auto& {
        return all[i / levels].levels[i % levels].growth;
      });
  if constexpr (V::reads) {
    std::vector<GrowthSums> sums;
    for (GrowthSums::Totals& totals : all)
      sums.push_back(GrowthSums::from(like.window(), like.blocks(), std::move(totals)));
    spectrum = SpectrumSums::from(std::move(sums), zeros);
  }
}

// Numbers of a replicate's orbits, a row each.
template <class V>
void describe_replicates(V& v, std::vector<GrowthSums::Totals>& parts) {
  constexpr std::size_t each = 3 + GrowthSums::looks;
  if (!v.has_if(!parts.empty(), "replicate_counts")) return;
  if constexpr (V::reads) parts.resize(replicates);
  v.kept_each(
      {"replicate_counts", "1",
       "Rows, one for each replicate of quasi-random starts: orbits, chaotic, linear, "
       "chaotic_at"},
      replicates * each, [&](std::size_t i) -> auto& {
        GrowthSums::Totals& t = parts[i / each];
        std::uint64_t* const first[] = {&t.orbits, &t.chaotic, &t.linear};
        return i % each < 3 ? *first[i % each] : t.chaotic_at[i % each - 3];
      });
  v.sums(
      {"replicates", "1",
       "Sums of growth, hits and growth of chaotic orbits of each replicate; digits as in totals"},
      3 * replicates, [&](std::size_t i) -> auto& {
        GrowthSums::Totals& t = parts[i / 3];
        ExactSum* const sums[] = {&t.growth, &t.hits, &t.chaotic_growth};
        return *sums[i % 3];
      });
}

template <class V, class Sums>
void describe_growth(V& v, Sums& growth) {
  TimeWindow window = growth.window();
  std::uint64_t blocks = growth.blocks();
  GrowthSums::Totals t = growth.totals();
  std::vector<GrowthSums::Totals> parts = growth.parts();
  v.kept({"from", "time", "Start of the window"}, window.from);
  v.kept({"to", "time", "End of the window"}, window.to);
  v.kept_rows([&] { return distribution_of(growth); });
  v.group("lyapunov_sums",
          "Sums over orbits of the growth of ln|deviation| in blocks of the window");
  v.number({"orbits", "1", "Particles that were followed to the end of the window"}, t.orbits);
  v.kept({"chaotic", "1", "Orbits found chaotic"}, t.chaotic);
  v.kept({"linear", "1",
          "Orbits whose deviations grew no more than linearly; the others are undecided"},
         t.linear);
  v.kept({"blocks", "1", "Blocks of the window"}, blocks);
  v.kept_each(
      {"chaotic_at", "1",
       "Orbits found chaotic by the window's end / 2^7, / 2^6 ... and at the end"},
      GrowthSums::looks, [&](std::size_t i) -> auto& { return t.chaotic_at[i]; });
  std::int64_t exponent = t.distribution.exponent(), first = t.distribution.first();
  v.kept({"bin_exponent", "1", "Width of the bins of growth: 2 to this power"}, exponent);
  v.kept({"bin_first", "1", "Start of the first bin, in widths"}, first);
  if constexpr (V::reads) {
    v.expect(exponent >= GrowingHistogram::finest && exponent <= 1023 &&
                 GrowthSums::may_be_blocks(blocks),
             "has impossible blocks or bins");
    t.distribution =
        GrowingHistogram::from(static_cast<int>(exponent), first,
                               v.template values<std::uint64_t>("lyapunov", "bin_count"));
    t.levels = GrowthSums::from(window, blocks, t).totals().levels;
  }
  v.sums(
      {"totals", "1",
       "Sums of growth, hits, growth of chaotic orbits and its squares, and of mean flights: in "
       "each row `digits` numbers, the i-th of them times 2^(32 (first + i) - 1074)"},
      5, [&](std::size_t i) -> auto& {
        ExactSum* const all[] = {&t.growth, &t.hits, &t.chaotic_growth, &t.chaotic_squares,
                                 &t.flights};
        return *all[i];
      });
  v.sums(
      {"squares", "1",
       "Sums of growth^2, growth hits and hits^2 over groups of 1, 2, 4 ... blocks; digits as in "
       "totals"},
      3 * t.levels.size(), [&](std::size_t i) -> auto& {
        GrowthSums::Squares& s = t.levels[i / 3];
        ExactSum* const all[] = {&s.growth, &s.product, &s.hits};
        return *all[i % 3];
      });
  describe_replicates(v, parts);
  if constexpr (V::reads) growth = GrowthSums::from(window, blocks, std::move(t), std::move(parts));
}

template <class V, results::OrConst<LyapunovResult> Result>
void describe(V& v, Result& result, const System& system) {
  v.group("fates", "Numbers of particles by their end before the end of the window");
  results::describe_ends(v, result, system);
  v.group("lyapunov", "Lyapunov exponents, their distribution, chaotic orbits");
  if constexpr (!V::reads) describe_estimates(v, result, system);
  describe_growth(v, result.growth);
  describe_drift(v, "drift", result.drift);
  describe_drift(v, "entropy_drift", result.entropy_drift);
  describe_spectrum(v, result.spectrum, result.growth);
  describe_convergence(v, result.convergence, result);
  describe_repeller(v, result.repeller);
}

}  // namespace carom::analyses
