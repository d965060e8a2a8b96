// Lyapunov exponents as datasets, and the exact sums that they come from.
#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <type_traits>
#include <utility>

#include "io/archive/ensemble_columns.hpp"
#include "io/archive/exact_sums.hpp"

namespace carom::io {

using hdf5::Description;
using hdf5::Handle;

namespace {

constexpr const char* group_name = "lyapunov";
constexpr const char* sums_name = "lyapunov_sums";
constexpr const char* repeller_name = "repeller";

template <class Points, class Get>
void write_points(const Handle& group, const char* name, const Points& points, Get get,
                  Description description, const std::string& file) {
  std::vector<std::decay_t<decltype(get(points.front()))>> values;
  for (const auto& point : points) values.push_back(get(point));
  hdf5::write_column(group.get(), name, std::span(std::as_const(values)), description, file);
}

// The numbers of a quantity that populations measured, by name.
template <class Repeller, class Visit>
void visit_quantities(Repeller& r, Visit visit) {
  visit("lambda", "1/time", "Exponent of the orbits that never leave", r.per_time);
  visit("per_collision", "1", "The same per hit", r.per_hit);
  visit("early", "1/time", "Exponent in the first half of the window", r.early);
  visit("late", "1/time", "Exponent in the second half", r.late);
  visit("change", "1/time", "Their difference", r.change);
}
template <class Repeller, class Visit>
void visit_numbers(Repeller& r, Visit visit) {
  visit("kick", "1", "The largest kick of copies, of v_parallel / v", r.kick);
  visit("kick_cost", "1", "Share of those left that kicks add", r.kick_cost.value);
  visit("kick_cost_stderr", "1", "Its standard error", r.kick_cost.error);
  visit("time_from", "time", "Mean time at the start of the window", r.time_from);
  visit("time_to", "time", "Mean time at its end", r.time);
  visit("for_ever", "1", "Share of the starts that can never leave", r.for_ever);
}
template <class Repeller, class Visit>
void visit_counts(Repeller& r, Visit visit) {
  visit("population", "Trajectories of each population", r.population);
  visit("hits_from", "Hits at the start of the window", r.hits_from);
  visit("hits_to", "Hits at its end", r.hits);
}

void write_repeller(const ArchiveFile& file, const RepellerExponent& r) {
  const std::string& name = file.name();
  const Handle g = file.group(repeller_name,
                              "Exponent of the orbits that never leave, by populations that are "
                              "kept alive by splitting");
  visit_quantities(r, [&](const std::string& key, const char* unit, const std::string& what,
                          const Extrapolated& e) {
    const auto number = [&](const std::string& column, double value, const std::string& text) {
      hdf5::write_number(g.get(), column.c_str(), value, {unit, text.c_str()}, name);
    };
    number(key, e.limit.value, what);
    number(key + "_stderr", e.limit.error, "Its standard error, by repetitions");
    number(key + "_extrapolation", e.extrapolation, "Its distance from that at the smallest kick");
    std::vector<double> values, errors;
    for (const Mean& mean : e.at_kick) values.push_back(mean.value), errors.push_back(mean.error);
    hdf5::write_column(g.get(), (key + "_at_kicks").c_str(), std::span<const double>(values),
                       {unit, "It at each kick"}, name);
    hdf5::write_column(g.get(), (key + "_at_kicks_stderr").c_str(), std::span<const double>(errors),
                       {unit, "Their standard errors"}, name);
  });
  visit_numbers(r, [&](const char* key, const char* unit, const char* what, double value) {
    hdf5::write_number(g.get(), key, value, {unit, what}, name);
  });
  visit_counts(r, [&](const char* key, const char* what, std::uint64_t value) {
    hdf5::write_number(g.get(), key, value, {"1", what}, name);
  });
  hdf5::write_number(g.get(), "repetitions", static_cast<std::uint64_t>(r.per_time.repetitions),
                     {"1", "Independent populations at each of three kicks"}, name);
}

std::optional<RepellerExponent> read_repeller(hid_t file, const std::string& name) {
  if (!hdf5::has(file, repeller_name)) return std::nullopt;
  const Handle g = open_group(file, repeller_name, name);
  const auto number = [&](const std::string& key) {
    return read_number<double>(g.get(), key, name);
  };
  const auto count = [&](const std::string& key) {
    return read_number<std::uint64_t>(g.get(), key, name);
  };
  RepellerExponent r;
  visit_quantities(r, [&](const std::string& key, const char*, const char*, Extrapolated& e) {
    e.limit = {number(key), number(key + "_stderr")};
    e.extrapolation = number(key + "_extrapolation");
    const auto values = hdf5::read_column<double>(g.get(), (key + "_at_kicks").c_str(), name),
               errors =
                   hdf5::read_column<double>(g.get(), (key + "_at_kicks_stderr").c_str(), name);
    if (values.size() != kick_sizes || errors.size() != kick_sizes)
      damaged(name, fmt::format("'/{}/{}_at_kicks' has lost rows", repeller_name, key));
    for (std::size_t i = 0; i < kick_sizes; ++i) e.at_kick[i] = {values[i], errors[i]};
    e.repetitions = count("repetitions");
  });
  visit_numbers(
      r, [&](const char* key, const char*, const char*, double& value) { value = number(key); });
  visit_counts(r, [&](const char* key, const char*, std::uint64_t& value) { value = count(key); });
  return r;
}

void write_estimates(const Handle& g, const GrowthSums& sums, const LyapunovEstimate& e,
                     const std::string& file) {
  const auto number = [&](const char* name, double value, Description description) {
    hdf5::write_number(g.get(), name, value, description, file);
  };
  number("lambda", e.per_time.value,
         {"1/time", "Largest exponent, mean over orbits; NaN: the run is too short"});
  number("lambda_stderr", e.per_time.error, {"1/time", "Its standard error"});
  number("per_collision", e.per_hit.value, {"1", "Largest exponent per hit"});
  number("per_collision_stderr", e.per_hit.error, {"1", "Its standard error"});
  number("chaotic_share", e.chaotic_share.value,
         {"1", "Share of the orbits that are chaotic; NaN: the run does not tell"});
  number("chaotic_share_stderr", e.chaotic_share.error,
         {"1", "The larger side of its 95 % interval over 1.96"});
  number("chaotic_share_low", e.share_interval.low, {"1", "Start of its 95 % interval"});
  number("chaotic_share_high", e.share_interval.high, {"1", "Its end"});
  number("from", sums.window().from, {"time", "Start of the window"});
  number("to", sums.window().to, {"time", "End of the window"});
  const auto bins = distribution_of(sums);
  write_points(
      g, "bin_from", bins, [](const auto& b) { return b.from; },
      {"1/time", "Finite-time exponents: start of the bin"}, file);
  write_points(
      g, "bin_to", bins, [](const auto& b) { return b.to; }, {"1/time", "Its end"}, file);
  write_points(
      g, "bin_count", bins, [](const auto& b) { return b.count; },
      {"1", "Orbits with an exponent in it"}, file);
}

void write_spectrum(const Handle& shown, const Handle& kept, const SpectrumSums& sums,
                    const std::string& file) {
  const SpectrumEstimate e = estimate_of(sums);
  write_points(
      shown, "spectrum", e.exponents, [](const Estimate& one) { return one.value; },
      {"1/time", "All exponents, the largest first"}, file);
  write_points(
      shown, "spectrum_stderr", e.exponents, [](const Estimate& one) { return one.error; },
      {"1/time", "Their standard errors"}, file);
  hdf5::write_number(shown.get(), "entropy", e.entropy.value,
                     {"1/time", "Entropy of Kolmogorov and Sinai"}, file);
  hdf5::write_number(shown.get(), "entropy_stderr", e.entropy.error,
                     {"1/time", "Its standard error"}, file);
  hdf5::write_number(kept.get(), "spectrum_zeros", static_cast<std::uint64_t>(sums.zeros()),
                     {"1", "Exponents that vanish by conservation laws"}, file);
  std::vector<const ExactSum*> totals, squares;
  for (const GrowthSums& one : sums.sums()) {
    totals.push_back(&one.totals().growth);
    for (const GrowthSums::Squares& level : one.totals().levels) squares.push_back(&level.growth);
  }
  write_sums(kept, "spectrum_totals", totals,
             {"1", "Growth of each length of the frame, and that of the entropy, likewise"}, file);
  write_sums(kept, "spectrum_squares", squares,
             {"1", "Of each, growth^2 over groups of 1, 2, 4 ... blocks, likewise"}, file);
}

// None where none was kept. `like`: sums over the same orbits.
SpectrumSums read_spectrum(const Handle& shown, const Handle& kept, const GrowthSums& like,
                           const std::string& file) {
  if (!hdf5::has(kept.get(), "spectrum_totals")) return {};
  const auto zeros = read_number<std::uint64_t>(kept.get(), "spectrum_zeros", file);
  const std::size_t count = hdf5::read_column<double>(shown.get(), "spectrum", file).size() + 1;
  const std::size_t levels = like.totals().levels.size();
  const auto totals = read_sums(kept, sums_name, "spectrum_totals", count, file),
             squares = read_sums(kept, sums_name, "spectrum_squares", count * levels, file);
  std::vector<GrowthSums> sums;
  for (std::size_t i = 0; i < count; ++i) {
    GrowthSums::Totals t;
    t.orbits = like.totals().orbits;
    t.linear = t.orbits;
    t.growth = totals[i];
    for (std::size_t level = 0; level < levels; ++level)
      t.levels.push_back({squares[i * levels + level], {}, {}});
    sums.push_back(GrowthSums::from(like.window(), like.blocks(), std::move(t)));
  }
  return SpectrumSums::from(std::move(sums), zeros);
}

constexpr const char* drifts[] = {"drift", "entropy_drift"};

void write_drift(const Handle& g, const char* column, const DriftSums& sums,
                 const std::string& file) {
  if (sums.orbits == 0) return;
  hdf5::write_number(g.get(), fmt::format("{}_orbits", column).c_str(), sums.orbits,
                     {"1", "Orbits of these sums"}, file);
  write_sums(
      g, column, {&sums.far, &sums.near, &sums.far_squares, &sums.near_squares, &sums.product},
      {"1/time, 1/time^2",
       "How much faster deviations grew than in T/4 to T: sums of x in T/64 to T/16, of y in "
       "T/16 to T/4, of x^2, y^2, xy, likewise"},
      file);
}

// None in archives of older versions.
DriftSums read_drift(const Handle& g, const char* column, const std::string& file) {
  DriftSums made;
  if (!hdf5::has(g.get(), column)) return made;
  const std::string orbits = fmt::format("{}_orbits", column);
  made.orbits = read_number<std::uint64_t>(g.get(), orbits, file);
  const auto sums = read_sums(g, sums_name, column, 5, file);
  made.far = sums[0], made.near = sums[1];
  made.far_squares = sums[2], made.near_squares = sums[3], made.product = sums[4];
  return made;
}

// Numbers of a replicate's orbits, one row each.
constexpr std::size_t counts_of_a_replicate = 3 + GrowthSums::looks;

void write_replicates(const Handle& g, const std::vector<GrowthSums::Totals>& parts,
                      const std::string& file) {
  std::vector<std::uint64_t> counts;
  std::vector<const ExactSum*> sums;
  for (const GrowthSums::Totals& t : parts) {
    counts.insert(counts.end(), {t.orbits, t.chaotic, t.linear});
    counts.insert(counts.end(), t.chaotic_at.begin(), t.chaotic_at.end());
    sums.insert(sums.end(), {&t.growth, &t.hits, &t.chaotic_growth});
  }
  hdf5::write_column(g.get(), "replicate_counts", std::span<const std::uint64_t>(counts),
                     {"1",
                      "Of each replicate of quasi-random starts, in rows: orbits, chaotic, linear, "
                      "chaotic_at"},
                     file);
  write_sums(g, "replicates", sums,
             {"1", "Of each replicate sums of growth, hits, growth of chaotic orbits, as totals"},
             file);
}

std::vector<GrowthSums::Totals> read_replicates(const Handle& g, const std::string& file) {
  if (!hdf5::has(g.get(), "replicate_counts")) return {};
  const auto counts = hdf5::read_column<std::uint64_t>(g.get(), "replicate_counts", file);
  if (counts.size() != replicates * counts_of_a_replicate)
    damaged(file, "'/lyapunov_sums/replicate_counts' has lost rows");
  const auto sums = read_sums(g, sums_name, "replicates", 3 * replicates, file);
  std::vector<GrowthSums::Totals> parts(replicates);
  for (std::size_t r = 0; r < replicates; ++r) {
    const auto row = counts.begin() + static_cast<std::ptrdiff_t>(r * counts_of_a_replicate);
    parts[r].orbits = row[0], parts[r].chaotic = row[1], parts[r].linear = row[2];
    std::copy_n(row + 3, GrowthSums::looks, parts[r].chaotic_at.begin());
    parts[r].growth = sums[3 * r], parts[r].hits = sums[3 * r + 1],
    parts[r].chaotic_growth = sums[3 * r + 2];
  }
  return parts;
}

}  // namespace

void write_counts(const ArchiveFile& file, const LyapunovResult& result, const System& system) {
  const std::string& name = file.name();
  const GrowthSums& sums = result.growth;
  const GrowthSums::Totals& t = sums.totals();
  const Handle shown =
      file.group(group_name, "Lyapunov exponents, their distribution, chaotic orbits");
  write_estimates(shown, sums, estimate_of(system, result), name);
  if (result.repeller) write_repeller(file, *result.repeller);
  const Handle g = file.group(
      sums_name, "Sums over orbits of the growth of ln|deviation| in blocks of the window");
  const auto count = [&](const char* column, std::uint64_t value, const char* text) {
    hdf5::write_number(g.get(), column, value, {"1", text}, name);
  };
  count("orbits", t.orbits, "Particles that were followed to the end of the window");
  count("chaotic", t.chaotic, "Of these, found chaotic");
  count("linear", t.linear,
        "Of these, deviations had grown no more than linearly; the others are undecided");
  count("blocks", sums.blocks(), "Blocks of the window");
  hdf5::write_column(g.get(), "chaotic_at", std::span<const std::uint64_t>(t.chaotic_at),
                     {"1", "Found chaotic by the window's end / 2^7, / 2^6 ... and at the end"},
                     name);
  hdf5::write_number(g.get(), "bin_exponent", static_cast<std::int64_t>(t.distribution.exponent()),
                     {"1", "The bins are 2^this wide, of growth"}, name);
  hdf5::write_number(g.get(), "bin_first", t.distribution.first(),
                     {"1", "The first begins at that many widths"}, name);
  write_sums(
      g, "totals", {&t.growth, &t.hits, &t.chaotic_growth, &t.chaotic_squares, &t.flights},
      {"1",
       "Sums of growth, hits, growth of chaotic orbits and its squares, and of mean flights: in "
       "each row `digits` numbers, the i-th of them times 2^(32 (first + i) - 1074)"},
      name);
  std::vector<const ExactSum*> squares;
  for (const GrowthSums::Squares& level : t.levels)
    for (const ExactSum* sum : {&level.growth, &level.product, &level.hits}) squares.push_back(sum);
  write_sums(
      g, "squares", squares,
      {"1", "Sums of growth^2, growth hits and hits^2 over groups of 1, 2, 4 ... blocks, likewise"},
      name);
  write_drift(g, drifts[0], result.drift, name);
  write_drift(g, drifts[1], result.entropy_drift, name);
  if (result.spectrum.counted()) write_spectrum(shown, g, result.spectrum, name);
  if (!sums.parts().empty()) write_replicates(g, sums.parts(), name);
  const Handle ends =
      file.group("fates", "Numbers of particles by their end before the end of the window");
  const auto contacts = system.of_discs() ? std::optional(result.contacts) : std::nullopt;
  write_ends(ends, result, {result.trajectories, result.collisions, result.digest, contacts}, name);
  if (is_integrated(system)) write_integration(ends.get(), result.steps, result.energy_error, name);
}

void read_counts(hid_t file, const std::string& name, LyapunovResult& result) {
  const Handle shown = open_group(file, group_name, name), g = open_group(file, sums_name, name),
               ends = open_group(file, "fates", name);
  const auto count = [&](const char* column) {
    return read_number<std::uint64_t>(g.get(), column, name);
  };
  const auto edge = [&](const char* column) {
    return read_number<double>(shown.get(), column, name);
  };
  const TimeWindow window{edge("from"), edge("to")};
  GrowthSums::Totals t;
  t.orbits = count("orbits"), t.chaotic = count("chaotic"), t.linear = count("linear");
  const auto at = hdf5::read_column<std::uint64_t>(g.get(), "chaotic_at", name);
  if (at.size() != t.chaotic_at.size()) damaged(name, "'/lyapunov_sums/chaotic_at' has lost rows");
  std::copy(at.begin(), at.end(), t.chaotic_at.begin());
  const auto exponent = read_number<std::int64_t>(g.get(), "bin_exponent", name),
             first = read_number<std::int64_t>(g.get(), "bin_first", name);
  const std::uint64_t blocks = count("blocks");
  if (exponent < GrowingHistogram::finest || exponent > 1023 || !GrowthSums::may_be_blocks(blocks))
    damaged(name, "'/lyapunov_sums' has impossible blocks or bins");
  t.distribution =
      GrowingHistogram::from(static_cast<int>(exponent), first,
                             hdf5::read_column<std::uint64_t>(shown.get(), "bin_count", name));
  const auto totals = read_sums(g, sums_name, "totals", 5, name);
  t.growth = totals[0], t.hits = totals[1], t.chaotic_growth = totals[2],
  t.chaotic_squares = totals[3], t.flights = totals[4];
  result.growth = GrowthSums::from(window, blocks, t);
  const std::size_t levels = result.growth.totals().levels.size();
  const auto squares = read_sums(g, sums_name, "squares", 3 * levels, name);
  for (std::size_t i = 0; i < levels; ++i)
    t.levels.push_back({squares[3 * i], squares[3 * i + 1], squares[3 * i + 2]});
  result.growth = GrowthSums::from(window, blocks, std::move(t), read_replicates(g, name));
  result.spectrum = read_spectrum(shown, g, result.growth, name);
  result.drift = read_drift(g, drifts[0], name);
  result.entropy_drift = read_drift(g, drifts[1], name);
  const EnsembleNumbers numbers = read_ends(ends, name, result);
  result.trajectories = numbers.particles;
  result.collisions = numbers.collisions;
  result.contacts = numbers.contacts.value_or(0);
  result.repeller = read_repeller(file, name);
  result.digest = numbers.digest;
  read_integration(ends.get(), name, result.steps, result.energy_error);
}

}  // namespace carom::io
