#include "io/archive/ensemble_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <type_traits>
#include <utility>

#include "carom/base/error.hpp"
#include "carom/table/hole_names.hpp"

namespace carom::io {

using hdf5::Description;
using hdf5::Handle;

namespace {

struct BinsOfReplicates {
  const char* name;
  std::vector<std::uint64_t> GoneCounts::*bins;
  const char* text;
};
constexpr BinsOfReplicates bins_of_replicates[] = {
    {"gone", &GoneCounts::gone_in, "As /survival/gone"},
    {"gone_hits", &GoneCounts::gone_in_hits, "By numbers of hits: 0, 1, 2, 3, 5, 10, 20 ..."},
    {"holes", &GoneCounts::hole_escapes, "As /fates/holes"}};

}  // namespace

void write_counts(const ArchiveFile& file, const EscapeResult& result, const System& system) {
  const std::vector<std::string> holes = hole_names(*system.table);
  const std::string& target = file.name();
  const auto column = [&](const Handle& group, const char* name, const auto& points, auto get,
                          Description description) {
    std::vector<std::decay_t<decltype(get(points.front()))>> values;
    for (const auto& point : points) values.push_back(get(point));
    hdf5::write_column(group.get(), name, std::span(std::as_const(values)), description, target);
  };
  const SurvivalCounts& counts = result.counts;
  {
    const auto points = survival(counts);
    const Handle group =
        file.group("survival", "Share of the non-singular trajectories still there");
    column(group, "t", points, [](const auto& p) { return p.t; }, {"time", "Time"});
    column(group, "p", points, [](const auto& p) { return p.p; },
           {"1", "Share still there after t"});
    column(group, "low", points, [](const auto& p) { return p.low; },
           {"1", "95 % interval, low end"});
    column(group, "high", points, [](const auto& p) { return p.high; },
           {"1", "95 % interval, high end"});
    column(group, "gone", counts.gone_in, [](std::uint64_t n) { return n; },
           {"1", "Trajectories gone after the time before and by t"});
  }
  const auto fine_bins = [&](const char* name, const char* text, const EscapeTimes& gone,
                             Description from) {
    const auto bins = gone.bins();
    const Handle group = file.group(name, text);
    column(
        group, "from", bins, [](const auto& bin) { return bin.from; }, from);
    column(group, "gone", bins, [](const auto& bin) { return bin.count; },
           {"1", "Trajectories gone in it"});
  };
  fine_bins("escape_times", "Trajectories gone in fine bins of time, 64 to a factor of two",
            counts.gone_at, {"time", "Start of the bin, in it; it ends where the next one starts"});
  fine_bins(
      "escape_hits", "Trajectories gone in fine bins of hits, 64 to a factor of two",
      counts.gone_after,
      {"1", "Start of the bin, in it; it holds hits less one, and ends where the next one starts"});
  {
    const auto points = survival_by_hits(counts);
    const Handle group = file.group(
        "survival_hits", "Share of the non-singular trajectories still there after n hits");
    column(group, "n", points, [](const auto& p) { return p.n; }, {"1", "Reflections"});
    column(group, "p", points, [](const auto& p) { return p.p; },
           {"1", "Share still there after n hits"});
    column(group, "low", points, [](const auto& p) { return p.low; },
           {"1", "95 % interval, low end"});
    column(group, "high", points, [](const auto& p) { return p.high; },
           {"1", "95 % interval, high end"});
    const std::vector<std::uint64_t> gone(
        counts.gone_in_hits.begin(),
        counts.gone_in_hits.begin() + static_cast<std::ptrdiff_t>(points.size()));
    column(group, "gone", gone, [](std::uint64_t n) { return n; },
           {"1", "Trajectories gone after more hits than the number before and at most n"});
  }
  {
    const auto points = escape_rate(counts);
    const Handle group = file.group("rate", "Escape rate: -dP/dt averaged over (from, to]");
    column(group, "t", points, [](const auto& p) { return p.t; },
           {"time", "Middle of the interval"});
    column(group, "from", points, [](const auto& p) { return p.from; },
           {"time", "Start of the interval"});
    column(group, "to", points, [](const auto& p) { return p.to; },
           {"time", "End of the interval"});
    column(group, "value", points, [](const auto& p) { return p.value; },
           {"1/time", "Escape rate"});
    column(group, "low", points, [](const auto& p) { return p.low; },
           {"1/time", "95 % interval, low end"});
    column(group, "high", points, [](const auto& p) { return p.high; },
           {"1/time", "95 % interval, high end"});
  }
  if (!counts.parts.empty()) {
    const Handle group = file.group(
        "replicates", "Trajectories gone of each replicate of quasi-random starts, in rows");
    column(group, "followed", counts.parts, [](const Replicate& part) { return part.followed; },
           {"1", "Trajectories whose fate is known"});
    for (const auto& [name, bins, text] : bins_of_replicates) {
      std::vector<std::uint64_t> rows;
      for (const Replicate& part : counts.parts)
        rows.insert(rows.end(), (part.*bins).begin(), (part.*bins).end());
      column(group, name, rows, [](std::uint64_t n) { return n; }, {"1", text});
    }
  }
  const Handle group = file.group("fates", "Numbers of trajectories by fate");
  const auto number = [&](const char* name, std::uint64_t value, const char* text) {
    hdf5::write_number(group.get(), name, value, {"1", text}, target);
  };
  number("trajectories", counts.trajectories, "All trajectories");
  write_fates(group, counts, target);
  number("collisions", counts.collisions, "Reflections of all trajectories");
  number("most_hits", counts.most_hits, "Most reflections of a single trajectory");
  number("fewest_hits_of_survivor", counts.fewest_hits_of_survivor,
         "Fewest reflections of one that is still there, not pinned; 2^64 - 1: there is none");
  if (system.of_discs())
    number("contacts", counts.contacts, "Contacts of hard discs, each pair once");
  if (is_integrated(system))
    write_integration(group.get(), result.steps, result.energy_error, target);
  if (system.dynamics.forces && !system.dynamics.forces->empty())
    hdf5::write_number(group.get(), "energy_change", counts.energy_change,
                       {"energy", "The largest change of a particle's energy"}, target);
  number("digest", result.digest,
         "Sum of a hash of each trajectory's end: other ends, another digest");
  if (!holes.empty()) {
    const Handle dataset =
        hdf5::create_fixed(group.get(), "holes", H5T_NATIVE_UINT64, holes.size(),
                           {"1", "Escapes by hole; names in the attribute `names`"}, target);
    hdf5::write_attribute(dataset.get(), "names", holes, target);
    hdf5::check(H5Dwrite(dataset.get(), H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                         counts.hole_escapes.data()) >= 0,
                target);
  }
  const Handle provenance = file.open_group("provenance");
  const auto write = [&](const char* name, std::uint64_t value) {
    hdf5::write_attribute(provenance.get(), name, static_cast<std::int64_t>(value), target);
  };
  write("lanes_hits", result.effort.hits);
  write("lanes_left", result.effort.scalar);
  write("lanes_steps", result.effort.steps);
  write("lanes_idle", result.effort.idle);
}

namespace {

std::uint64_t total(const std::vector<std::uint64_t>& numbers) {
  return std::accumulate(numbers.begin(), numbers.end(), std::uint64_t{0});
}

}  // namespace

void read_counts(hid_t file, const std::string& name, EscapeResult& result) {
  const auto integers = [&](const Handle& group, const char* column) {
    return hdf5::read_column<std::uint64_t>(group.get(), column, name);
  };
  SurvivalCounts& counts = result.counts;
  const Handle survival = open_group(file, "survival", name),
               hits = open_group(file, "survival_hits", name);
  const Handle fates = open_group(file, "fates", name),
               provenance = open_group(file, "provenance", name);
  const auto number = [&](const char* what) {
    return read_number<std::uint64_t>(fates.get(), what, name);
  };
  std::vector<std::uint64_t> by_hole;
  if (hdf5::has(fates.get(), "holes")) by_hole = integers(fates, "holes");
  counts = SurvivalCounts(hdf5::read_column<double>(survival.get(), "t", name), by_hole.size());
  counts.hole_escapes = by_hole;
  counts.gone_in = integers(survival, "gone");
  const auto read_bins = [&](const char* what, EscapeTimes& gone_in) {
    const Handle fine = open_group(file, what, name);
    const auto from = hdf5::read_column<double>(fine.get(), "from", name);
    const std::vector<std::uint64_t> gone = integers(fine, "gone");
    if (from.size() != gone.size())
      damaged(name, fmt::format("'/{0}/from' and '/{0}/gone' differ in length", what));
    for (std::size_t i = 0; i < from.size(); ++i) {
      if (!(from[i] > 0.0) || EscapeTimes::bin_of(from[i]).from != from[i])
        damaged(name, fmt::format("'/{}/from' is not the start of a bin", what));
      gone_in.add(from[i], gone[i]);
    }
  };
  read_bins("escape_times", counts.gone_at);
  read_bins("escape_hits", counts.gone_after);
  const std::vector<std::uint64_t> gone_in_hits = integers(hits, "gone");
  if (counts.gone_in.size() != counts.times.size())
    damaged(name, "'/survival/t' and '/survival/gone' differ in length");
  if (gone_in_hits.size() > counts.gone_in_hits.size())
    damaged(name, "'/survival_hits/gone' is too long");
  std::copy(gone_in_hits.begin(), gone_in_hits.end(), counts.gone_in_hits.begin());
  if (hdf5::has(file, "replicates")) {
    const Handle rows = open_group(file, "replicates", name);
    counts.parts.assign(replicates, {counts, 0});
    const std::vector<std::uint64_t> followed = integers(rows, "followed");
    if (followed.size() != replicates) damaged(name, "'/replicates/followed' has lost rows");
    for (std::size_t r = 0; r < replicates; ++r) counts.parts[r].followed = followed[r];
    for (const auto& [column, bins, text] : bins_of_replicates) {
      const std::vector<std::uint64_t> all = integers(rows, column);
      const std::size_t each = (counts.*bins).size();
      if (all.size() != replicates * each)
        damaged(name, fmt::format("'/replicates/{}' has lost numbers", column));
      for (std::size_t r = 0; r < replicates; ++r)
        (counts.parts[r].*bins)
            .assign(all.begin() + static_cast<std::ptrdiff_t>(r * each),
                    all.begin() + static_cast<std::ptrdiff_t>((r + 1) * each));
    }
  }
  counts.trajectories = number("trajectories");
  static_cast<FateCounts&>(counts) = read_fates(fates, name, counts.trajectories);
  counts.collisions = number("collisions");
  counts.most_hits = number("most_hits");
  counts.fewest_hits_of_survivor = number("fewest_hits_of_survivor");
  if (hdf5::has(fates.get(), "contacts")) counts.contacts = number("contacts");
  if (hdf5::has(fates.get(), "energy_change"))
    counts.energy_change = read_number<double>(fates.get(), "energy_change", name);
  const std::uint64_t gone = counts.escaped;
  if (total(counts.gone_in) > gone) damaged(name, "'/survival/gone' has more than '/fates'");
  if (counts.gone_at.total() > gone) damaged(name, "'/escape_times/gone' has more than '/fates'");
  if (counts.gone_after.total() > gone) damaged(name, "'/escape_hits/gone' has more than '/fates'");
  if (total(counts.gone_in_hits) > gone)
    damaged(name, "'/survival_hits/gone' has more than '/fates'");
  result.digest = number("digest");
  read_integration(fates.get(), name, result.steps, result.energy_error);
  const auto effort = [&](const char* what) {
    return static_cast<std::uint64_t>(hdf5::read_integer_attribute(provenance.get(), what, name));
  };
  result.effort = {effort("lanes_hits"), effort("lanes_left"), effort("lanes_steps"),
                   effort("lanes_idle")};
}

}  // namespace carom::io
