// The moments of a diffusing ensemble as datasets, and the exact sums that they come from.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <type_traits>
#include <utility>

#include "io/archive/ensemble_columns.hpp"

namespace carom::io {

using hdf5::Description;
using hdf5::Handle;

namespace {

using Sum = DisplacementSums::Sum;
using Digits = std::array<std::int64_t, ExactSum::digits>;

// Sums with all their digits: of each those from the lowest to the highest that any of them has, so
// equal sums make equal datasets.
void write_sums(const Handle& group, const char* name, const std::vector<const ExactSum*>& sums,
                Description description, const std::string& file) {
  std::vector<Digits> states;
  for (const ExactSum* sum : sums) states.push_back(sum->state());
  std::size_t first = ExactSum::digits, end = 0;
  for (const Digits& digits : states)
    for (std::size_t i = 0; i < digits.size(); ++i)
      if (digits[i] != 0) first = std::min(first, i), end = std::max(end, i + 1);
  first = std::min(first, end);
  std::vector<std::int64_t> column;
  for (const Digits& digits : states)
    column.insert(column.end(), digits.begin() + static_cast<std::ptrdiff_t>(first),
                  digits.begin() + static_cast<std::ptrdiff_t>(end));
  hdf5::write_column(group.get(), name, std::span(std::as_const(column)), description, file);
  const Handle dataset = hdf5::open_column(group.get(), name, file);
  hdf5::write_attribute(dataset.get(), "first", static_cast<std::int64_t>(first), file);
  hdf5::write_attribute(dataset.get(), "digits", static_cast<std::int64_t>(end - first), file);
}

std::vector<ExactSum> read_sums(const Handle& group, const char* name, std::size_t count,
                                const std::string& file) {
  const auto column = hdf5::read_column<std::int64_t>(group.get(), name, file);
  const Handle dataset = hdf5::open_column(group.get(), name, file);
  const auto first =
      static_cast<std::uint64_t>(hdf5::read_integer_attribute(dataset.get(), "first", file));
  const auto each =
      static_cast<std::uint64_t>(hdf5::read_integer_attribute(dataset.get(), "digits", file));
  if (first > ExactSum::digits || each > ExactSum::digits - first || column.size() != each * count)
    damaged(file, fmt::format("'/msd_groups/{}' has lost digits", name));
  std::vector<ExactSum> sums;
  for (std::size_t i = 0; i < count; ++i) {
    Digits digits{};
    std::copy_n(column.begin() + static_cast<std::ptrdiff_t>(i * each), each,
                digits.begin() + static_cast<std::ptrdiff_t>(first));
    sums.push_back(ExactSum::from_state(digits));
  }
  return sums;
}

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
  column("exponent", [](Point p) { return p.exponent.value; },
         {"1", "d ln MSD / d ln t since the time before; NaN where there is none"});
  column("exponent_stderr", [](Point p) { return p.exponent.error; }, {"1", "Its standard error"});
}

// Group by group, for errors of whatever is computed from the moments.
void write_groups(const ArchiveFile& file, const DisplacementSums& sums) {
  std::vector<std::uint64_t> counts;
  std::vector<double> rounded;
  std::vector<const ExactSum*> squares, fourths;
  for (std::size_t group = 0; group < DisplacementSums::groups; ++group)
    for (std::size_t k = 0; k < sums.times().size(); ++k) {
      const Sum& sum = sums.of(group, k);
      counts.push_back(sum.count);
      rounded.push_back(sum.square.value());
      squares.push_back(&sum.square);
      fourths.push_back(&sum.fourth);
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
}

struct Number {
  const char* name;
  std::uint64_t DiffusionResult::*value;
  const char* text;
};
constexpr Number numbers[] = {
    {"trajectories", &DiffusionResult::trajectories, "All particles of all trajectories"},
    {"survived", &DiffusionResult::survived, "Still there at the end"},
    {"pinned", &DiffusionResult::pinned, "Survivors on a cyclotron orbit that never hits"},
    {"escaped", &DiffusionResult::escaped, "Left through a hole, or to infinity"},
    {"capped", &DiffusionResult::capped, "Ended by the cap on hits"},
    {"singular", &DiffusionResult::singular, "Ended where no continuation is defined"},
    {"unbounded", &DiffusionResult::unbounded, "Escaped to infinity: no wall follows any more"},
    {"lost", &DiffusionResult::lost, "Internal errors: always 0"},
    {"collisions", &DiffusionResult::collisions, "Reflections of all particles"},
};
constexpr const char* digest = "digest";
constexpr const char* energy_change = "energy_change";

}  // namespace

void write_counts(const ArchiveFile& file, const DiffusionResult& result, const System& system) {
  write_moments(file, result.sums, system.particles.size());
  write_groups(file, result.sums);
  const Handle ends =
      file.group("fates", "Numbers of particles by their end before the last report time");
  const auto write = [&](const char* name, const auto& value, Description description) {
    hdf5::write_number(ends.get(), name, value, description, file.name());
  };
  for (const Number& number : numbers) write(number.name, result.*number.value, {"1", number.text});
  write("unresolved", result.unresolved, {"1", "Ended where integration could not follow"});
  if (is_integrated(system)) write_integration(ends.get(), result, file.name());
  write(energy_change, result.energy_change,
        {"energy", "With forces: the largest change of a trajectory's energy"});
  write(digest, result.digest,
        {"1", "Sum of a hash of each trajectory's end: other ends, another digest"});
}

void read_counts(hid_t file, const std::string& name, DiffusionResult& result) {
  const Handle msd = open_group(file, "msd", name), by = open_group(file, "msd_groups", name),
               ends = open_group(file, "fates", name);
  result.sums = DisplacementSums(hdf5::read_column<double>(msd.get(), "t", name));
  const auto counts = hdf5::read_column<std::uint64_t>(by.get(), "count", name);
  const std::size_t times = result.sums.times().size();
  if (counts.size() != DisplacementSums::groups * times)
    damaged(name, "'/msd_groups/count' has not one row a group and time of '/msd/t'");
  const auto squares = read_sums(by, "square_digits", counts.size(), name),
             fourths = read_sums(by, "fourth_digits", counts.size(), name);
  for (std::size_t i = 0; i < counts.size(); ++i)
    result.sums.merge(i / times, i % times, {counts[i], squares[i], fourths[i]});
  const auto read = [&](auto& value, const char* column) {
    value = read_number<std::decay_t<decltype(value)>>(ends.get(), column,
                                                       fmt::format("/fates/{}", column), name);
  };
  for (const Number& number : numbers) read(result.*number.value, number.name);
  result.unresolved = read_unresolved(ends.get(), name);
  read_integration(ends.get(), name, result);
  read(result.energy_change, energy_change);
  read(result.digest, digest);
}

}  // namespace carom::io
