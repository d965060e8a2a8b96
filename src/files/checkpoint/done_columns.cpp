// Which trajectories an ensemble's archive counts.
#include <fmt/format.h>

#include <charconv>
#include <span>
#include <sstream>
#include <utility>

#include "files/checkpoint/ensemble_columns.hpp"

namespace carom::files {

using hdf5::Description;
using hdf5::Handle;

void write_done(const ArchiveFile& file, const EnsembleResult& result) {
  std::vector<std::uint64_t> first, last;
  for (const TrajectoryRange& range : result.done.ranges())
    first.push_back(range.first), last.push_back(range.last);
  const Handle group = file.group("done", "Trajectories first … last - 1 are counted here");
  hdf5::write_column(group.get(), "first", std::span(std::as_const(first)),
                     {"1", "First trajectory"}, file.name());
  hdf5::write_column(group.get(), "last", std::span(std::as_const(last)),
                     {"1", "One after the last"}, file.name());
  if (result.reports.empty()) return;
  std::string text;
  for (const auto& [index, report] : result.reports) text += fmt::format("{}\t{}\n", index, report);
  hdf5::write_text(file.id(), "lost", text,
                   {"text",
                    "The first trajectories that were lost or unresolved: index, reason, state in "
                    "hexadecimal numbers, between tabs"},
                   file.name());
}

void read_done(hid_t file, const std::string& name, EnsembleResult& result) {
  const Handle done = open_group(file, "done", name);
  const auto first = hdf5::read_column<std::uint64_t>(done.get(), "first", name);
  const auto last = hdf5::read_column<std::uint64_t>(done.get(), "last", name);
  if (first.size() != last.size()) damaged(name, "'/done/first' and '/done/last' differ in length");
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (first[i] >= last[i]) damaged(name, "'/done/first' is not below '/done/last'");
    if (!result.done.add(TrajectoryRange{first[i], last[i]}))
      damaged(name, "'/done' counts trajectories twice");
  }
  if (!hdf5::has(file, "lost")) return;
  std::istringstream lines(hdf5::read_text(file, "lost", name));
  for (std::string line; std::getline(lines, line);) {
    const std::size_t tab = line.find('\t');
    std::uint64_t index = 0;
    const bool starts_with_index =
        tab != std::string::npos && tab > 0 &&
        std::from_chars(line.data(), line.data() + tab, index).ptr == line.data() + tab;
    if (!starts_with_index) damaged(name, "a line of '/lost' does not begin with an index");
    result.reports.emplace_back(index, line.substr(tab + 1));
  }
}

void write_integration(hid_t fates, const StepCounts& steps, const EnergyError& energy,
                       const std::string& name) {
  write_numbers(fates, steps, name);
  write_numbers(fates, energy, name);
}

void read_integration(hid_t fates, const std::string& name, StepCounts& steps,
                      EnergyError& energy) {
  if (!hdf5::has(fates, "steps")) return;
  read_numbers(fates, steps, name);
  read_numbers(fates, energy, name);
}

}  // namespace carom::files
