// The moments of a diffusing ensemble as datasets, and the exact sums that they come from.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <type_traits>
#include <utility>

#include "io/archive/ensemble_columns.hpp"
#include "io/archive/exact_sums.hpp"
#include "io/archive/free_path_columns.hpp"

namespace carom::io {

using hdf5::Description;
using hdf5::Handle;

namespace {

using Sum = DisplacementSums::Sum;
void write_moments(const ArchiveFile& file, const DisplacementSums& sums, std::size_t particles) {
  using Point = const MomentPoint&;
  const std::vector<MomentPoint> points = DisplacementMoments(sums, particles).points();
  const Handle g = file.group("msd", "Moments of the displacement in the plane since t = 0");
  const auto column = [&](const char* name, auto get, Description description) {
    std::vector<std::decay_t<decltype(get(points.front()))>> values;
    for (const MomentPoint& point : points) values.push_back(get(point));
    hdf5::write_column(g.get(), name, std::span(std::as_const(values)), description, file.name());
  };
  column("t", [](Point p) { return p.t; }, {"time", "Time"});
  column("count", [](Point p) { return p.count; }, {"1", "Particles there at t"});
  column("value", [](Point p) { return p.square.value; }, {"length^2", "Mean square displacement"});
  column("stderr", [](Point p) { return p.square.error; }, {"length^2", "Its standard error"});
  column("fourth", [](Point p) { return p.fourth.value; },
         {"length^4", "Mean fourth power of the displacement"});
  column("fourth_stderr", [](Point p) { return p.fourth.error; },
         {"length^4", "Its standard error"});
  column("correlation", [](Point p) { return p.correlation.value; },
         {"length^2/time^2", "Velocity autocorrelation <v(t).v(0)>"});
  column("correlation_stderr", [](Point p) { return p.correlation.error; },
         {"length^2/time^2", "Its standard error"});
  column("green_kubo", [](Point p) { return p.green_kubo.value; },
         {"length^2/time", "Half the integral of the velocity autocorrelation from 0 to t"});
  column("green_kubo_stderr", [](Point p) { return p.green_kubo.error; },
         {"length^2/time", "Its standard error"});
  column("exponent", [](Point p) { return p.exponent.value; },
         {"1", "d ln MSD / d ln t since the time before; NaN where there is none"});
  column("exponent_stderr", [](Point p) { return p.exponent.error; }, {"1", "Its standard error"});
}

// Group by group, for errors of whatever is computed from the moments.
void write_groups(const ArchiveFile& file, const DisplacementSums& sums) {
  std::vector<std::uint64_t> counts;
  std::vector<double> rounded;
  std::vector<const ExactSum*> squares, fourths, velocities, along;
  for (std::size_t group = 0; group < DisplacementSums::groups; ++group)
    for (std::size_t k = 0; k < sums.times().size(); ++k) {
      const Sum& sum = sums.of(group, k);
      counts.push_back(sum.count);
      rounded.push_back(sum.square.value());
      squares.push_back(&sum.square);
      fourths.push_back(&sum.fourth);
      velocities.push_back(&sum.velocities);
      along.push_back(&sum.along);
    }
  const Handle by = file.group(
      "msd_groups", "Sums by group of trajectories (index modulo 128): row group * times + time");
  hdf5::write_column(by.get(), "count", std::span(std::as_const(counts)),
                     {"1", "Particles there at t"}, file.name());
  hdf5::write_column(by.get(), "square", std::span(std::as_const(rounded)),
                     {"length^2", "Sum of their squared displacements"}, file.name());
  write_sums(by, "square_digits", squares,
             {"length^2",
              "The same without rounding: in each row `digits` numbers, the i-th of them times "
              "2^(32 (first + i) - 1074)"},
             file.name());
  write_sums(by, "fourth_digits", fourths,
             {"length^4", "Sum of the fourth powers of their displacements, likewise"},
             file.name());
  write_sums(by, "velocities_digits", velocities, {"length^2/time^2", "Sum of v(t).v(0), likewise"},
             file.name());
  write_sums(by, "along_digits", along, {"length^2/time", "Sum of v(0).(r(t) - r(0)), likewise"},
             file.name());
}

constexpr const char* energy_change = "energy_change";

}  // namespace

void write_counts(const ArchiveFile& file, const DiffusionResult& result, const System& system) {
  write_moments(file, result.sums, system.particles.size());
  write_groups(file, result.sums);
  write_free_paths(file, result.free_paths);
  const Handle ends =
      file.group("fates", "Numbers of particles by their end before the last report time");
  const auto contacts = system.of_discs() ? std::optional(result.contacts) : std::nullopt;
  write_ends(ends, result, {result.trajectories, result.collisions, result.digest, contacts},
             file.name());
  if (is_integrated(system))
    write_integration(ends.get(), result.steps, result.energy_error, file.name());
  hdf5::write_number(ends.get(), energy_change, result.energy_change,
                     {"energy", "With forces: the largest change of a trajectory's energy"},
                     file.name());
}

void read_counts(hid_t file, const std::string& name, DiffusionResult& result) {
  const Handle msd = open_group(file, "msd", name), by = open_group(file, "msd_groups", name),
               ends = open_group(file, "fates", name);
  result.sums = DisplacementSums(hdf5::read_column<double>(msd.get(), "t", name));
  const auto counts = hdf5::read_column<std::uint64_t>(by.get(), "count", name);
  const std::size_t times = result.sums.times().size();
  if (counts.size() != DisplacementSums::groups * times)
    damaged(name, "'/msd_groups/count' has not one row a group and time of '/msd/t'");
  if (!hdf5::has(by.get(), "velocities_digits"))
    throw InputError(Place{name, 0, 0, ""},
                     "the archive has no velocity autocorrelation: an earlier build wrote it",
                     "an archive of this build; its datasets can still be read by other programs");
  const auto sums = [&](const char* dataset) {
    return read_sums(by, "msd_groups", dataset, counts.size(), name);
  };
  const auto squares = sums("square_digits"), fourths = sums("fourth_digits"),
             velocities = sums("velocities_digits"), along = sums("along_digits");
  for (std::size_t i = 0; i < counts.size(); ++i)
    result.sums.merge(i / times, i % times,
                      {counts[i], squares[i], fourths[i], velocities[i], along[i]});
  result.free_paths = read_free_paths(file, name);
  const EnsembleNumbers numbers = read_ends(ends, name, result);
  result.trajectories = numbers.particles;
  result.collisions = numbers.collisions;
  result.contacts = numbers.contacts.value_or(0);
  result.digest = numbers.digest;
  read_integration(ends.get(), name, result.steps, result.energy_error);
  result.energy_change = read_number<double>(ends.get(), energy_change, name);
}

}  // namespace carom::io
