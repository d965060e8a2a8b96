#include "io/archive/free_path_columns.hpp"

#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "io/archive/ensemble_columns.hpp"
#include "io/archive/exact_sums.hpp"

namespace carom::io {

using hdf5::Description;
using hdf5::Handle;

namespace {

using Flights = FreePathSums::Flights;
constexpr const char* by_group = "free_path_groups";

template <class T>
void write(const Handle& group, const std::string& name, const std::vector<T>& values,
           Description description, const ArchiveFile& file) {
  hdf5::write_column(group.get(), name.c_str(), std::span(values), description, file.name());
}

void write_distribution(const ArchiveFile& file, const char* name, const char* description,
                        const FreePathDistribution& distribution) {
  const Handle group = file.group(name, description);
  const auto column = [&](const char* dataset, auto get, Description what) {
    std::vector<std::decay_t<decltype(get(FreePathBin()))>> values;
    for (const FreePathBin& bin : distribution.bins) values.push_back(get(bin));
    write(group, dataset, values, what, file);
  };
  using Bin = const FreePathBin&;
  column("from", [](Bin b) { return b.from; }, {"length", "Start of the bin"});
  column("to", [](Bin b) { return b.to; }, {"length", "End of the bin"});
  column("count", [](Bin b) { return b.count; }, {"1", "Flights of from <= length < to"});
  column("density", [](Bin b) { return b.density.value; },
         {"1/length", "Share of all flights, per length"});
  column("density_stderr", [](Bin b) { return b.density.error; },
         {"1/length", "Its standard error"});
  column("longer", [](Bin b) { return b.longer.value; },
         {"1", "Share of the flights that are at least `from` long"});
  column("longer_stderr", [](Bin b) { return b.longer.error; }, {"1", "Its standard error"});
}

// What is needed to add up parts: counts of bins that are not empty, a row each.
void write_flights(const Handle& group, const std::string& prefix, const FreePathSums& sums,
                   Flights FreePathSums::Sum::*what, const ArchiveFile& file) {
  std::vector<std::uint64_t> groups, counts, longer;
  std::vector<double> from;
  for (std::size_t g = 0; g < FreePathSums::groups; ++g) {
    const Flights& flights = sums.of(g).*what;
    longer.push_back(flights.longer);
    for (const auto& bin : flights.bins.bins())
      if (bin.count > 0) {
        groups.push_back(g);
        from.push_back(bin.from);
        counts.push_back(bin.count);
      }
  }
  write(group, prefix + "group", groups, {"1", "Group of trajectories (index modulo 128)"}, file);
  write(group, prefix + "from", from, {"length", "Start of a bin, eight to a factor of two"}, file);
  write(group, prefix + "count", counts, {"1", "Flights of the group in this bin"}, file);
  write(group, prefix + "longer", longer, {"1", "Flights of each group beyond the limit"}, file);
}

void read_flights(const Handle& group, const std::string& prefix, const std::string& name,
                  Flights FreePathSums::Sum::*what, std::vector<FreePathSums::Sum>& sums) {
  const auto column = [&]<class T>(const char* dataset, T) {
    return hdf5::read_column<T>(group.get(), (prefix + dataset).c_str(), name);
  };
  const auto groups = column("group", std::uint64_t{}), counts = column("count", std::uint64_t{}),
             longer = column("longer", std::uint64_t{});
  const auto from = column("from", 0.0);
  if (groups.size() != counts.size() || groups.size() != from.size() ||
      longer.size() != sums.size())
    damaged(name, "the columns of '/free_path_groups' differ in length");
  for (std::size_t g = 0; g < sums.size(); ++g) (sums[g].*what).longer = longer[g];
  for (std::size_t i = 0; i < groups.size(); ++i) {
    if (groups[i] >= sums.size() || !(from[i] > 0.0) ||
        FreePathSums::Bins::bin_of(from[i]).from != from[i])
      damaged(name, "'/free_path_groups' has rows that are no bins");
    (sums[groups[i]].*what).bins.add(from[i], counts[i]);
  }
}

}  // namespace

void write_free_paths(const ArchiveFile& file, const FreePathSums& sums) {
  if (!sums.counted()) return;
  const FreePaths paths = free_paths_of(sums);
  write_distribution(file, "free_paths", "Lengths of flights from one hit to the next",
                     paths.between);
  write_distribution(file, "free_paths_at_start", "Lengths of flights from the start",
                     paths.at_start);
  const Handle by = file.group(by_group, "The same by group of trajectories (index modulo 128)");
  hdf5::write_number(by.get(), "limit", sums.limit(),
                     {"length", "Flights of this length or more are only counted as longer"},
                     file.name());
  std::vector<std::uint64_t> hits;
  std::vector<const ExactSum*> path;
  for (std::size_t g = 0; g < FreePathSums::groups; ++g) {
    hits.push_back(sums.of(g).hits);
    path.push_back(&sums.of(g).path);
  }
  write(by, "hits", hits, {"1", "Hits of the particles of each group"}, file);
  write_sums(by, "path_digits", path,
             {"length", "Length of all that they flew, without rounding: digits as of /msd_groups"},
             file.name());
  write_flights(by, "", sums, &FreePathSums::Sum::between, file);
  write_flights(by, "start_", sums, &FreePathSums::Sum::at_start, file);
}

FreePathSums read_free_paths(hid_t file, const std::string& name) {
  if (!hdf5::has(file, by_group)) return {};
  const Handle by = open_group(file, by_group, name);
  FreePathSums sums(read_number<double>(by.get(), "limit", name));
  const auto hits = hdf5::read_column<std::uint64_t>(by.get(), "hits", name);
  if (hits.size() != FreePathSums::groups)
    damaged(name, "'/free_path_groups/hits' has not one row a group");
  const std::vector<ExactSum> path =
      read_sums(by, by_group, "path_digits", FreePathSums::groups, name);
  std::vector<FreePathSums::Sum> read(FreePathSums::groups);
  for (std::size_t g = 0; g < read.size(); ++g) {
    read[g].hits = hits[g];
    read[g].path = path[g];
  }
  read_flights(by, "", name, &FreePathSums::Sum::between, read);
  read_flights(by, "start_", name, &FreePathSums::Sum::at_start, read);
  for (std::size_t g = 0; g < read.size(); ++g) sums.merge(g, read[g]);
  return sums;
}

}  // namespace carom::io
