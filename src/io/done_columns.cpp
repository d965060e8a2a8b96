// Which trajectories an ensemble's archive counts.
#include <fmt/format.h>

#include <span>
#include <sstream>
#include <utility>

#include "carom/base/error.hpp"
#include "io/ensemble_columns.hpp"

namespace carom {

using hdf5::Handle;

Handle open_group(hid_t file, const char* group, const std::string& name) {
  Handle handle(H5Gopen2(file, group, H5P_DEFAULT), H5Gclose);
  if (!handle) throw InputError(Place{name, 0, 0, ""}, fmt::format("'{}' is missing", group), "an archive of an ensemble");
  return handle;
}

void write_done(const ArchiveFile& file, const EnsembleResult& result) {
  std::vector<std::uint64_t> first, last;
  for (const TrajectoryRange& range : result.done.ranges()) first.push_back(range.first), last.push_back(range.last);
  const Handle group = file.group("done", "Trajectories first … last - 1 are counted here");
  hdf5::write_column(group.get(), "first", std::span(std::as_const(first)), {"1", "First trajectory"}, file.name());
  hdf5::write_column(group.get(), "last", std::span(std::as_const(last)), {"1", "One after the last"}, file.name());
  if (result.reports.empty()) return;
  std::string text;
  for (const auto& [index, report] : result.reports) text += fmt::format("{}\t{}\n", index, report);
  hdf5::write_text(file.id(), "lost", text, {"text", "Index and state of the first lost trajectories"}, file.name());
}

void read_done(hid_t file, const std::string& name, EnsembleResult& result) {
  const Handle done = open_group(file, "done", name);
  const auto first = hdf5::read_column<std::uint64_t>(done.get(), "first", name);
  const auto last = hdf5::read_column<std::uint64_t>(done.get(), "last", name);
  for (std::size_t i = 0; i < first.size(); ++i)
    if (!result.done.add(TrajectoryRange{first[i], last.at(i)}))
      throw InputError(Place{name, 0, 0, ""}, "it counts trajectories twice");
  if (H5Lexists(file, "lost", H5P_DEFAULT) <= 0) return;
  std::istringstream lines(hdf5::read_text(file, "lost", name));
  for (std::string line; std::getline(lines, line);) {
    const std::size_t tab = line.find('\t');
    if (tab == std::string::npos) continue;
    result.reports.emplace_back(std::stoull(line.substr(0, tab)), line.substr(tab + 1));
  }
}

}  // namespace carom
