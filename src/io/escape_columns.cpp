#include "io/escape_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <sstream>
#include <type_traits>
#include <utility>

#include "carom/base/error.hpp"

namespace carom {

using hdf5::Description;
using hdf5::Handle;

hdf5::Columns create_records(const ArchiveFile& file, const std::vector<std::string>& holes) {
  const std::string& target = file.name();
  hdf5::Columns trajectories(target);
  const Handle group = file.group("trajectories", "Start and end of each trajectory, by index");
  const hid_t to = group.get();
  trajectories.add<std::uint64_t>(to, "index", {"1", "trajectory * particles + particle; with injections trajectory * 2^20 + particle"});
  trajectories.add<double>(to, "x", {"length", "Start, unwrapped"});
  trajectories.add<double>(to, "y", {"length", "Start, unwrapped"});
  trajectories.add<double>(to, "vx", {"length/time", "Velocity at the start"});
  trajectories.add<double>(to, "vy", {"length/time", "Velocity at the start"});
  const hid_t fate = trajectories.add<std::int32_t>(to, "fate", {"1", "Index into the attribute `names`"});
  std::vector<std::string> names;
  for (int i = 0; i <= static_cast<int>(Fate::lost); ++i) names.push_back(name_of(static_cast<Fate>(i)));
  hdf5::write_attribute(fate, "names", names, target);
  const hid_t hole = trajectories.add<std::int32_t>(
      to, "hole", {"1", "Index into the attribute `names`, -1: did not escape"});
  if (!holes.empty()) hdf5::write_attribute(hole, "names", holes, target);
  trajectories.add<double>(to, "t",
                           {"time", "End: escape, last hit of an unbounded one, else the time reached"});
  trajectories.add<std::uint64_t>(to, "hits", {"1", "Reflections"});
  return trajectories;
}

void append_records(hdf5::Columns& trajectories, const std::vector<TrajectoryRecord>& records) {
  for (const TrajectoryRecord& r : records)
    trajectories.row(r.index, r.x, r.y, r.vx, r.vy, static_cast<std::int32_t>(r.fate), r.hole, r.time, r.hits);
}

void write_counts(const ArchiveFile& file, const EscapeResult& result, const std::vector<std::string>& holes,
                  bool of_discs) {
  const std::string& target = file.name();
  const auto column = [&](const Handle& group, const char* name, const auto& points, auto get, Description description) {
    std::vector<std::decay_t<decltype(get(points.front()))>> values;
    for (const auto& point : points) values.push_back(get(point));
    hdf5::write_column(group.get(), name, std::span(std::as_const(values)), description, target);
  };
  const SurvivalCounts& counts = result.counts;
  {
    const auto points = survival(counts);
    const Handle group = file.group("survival", "Share of the non-singular trajectories still there");
    column(group, "t", points, [](const auto& p) { return p.t; }, {"time", "Time"});
    column(group, "p", points, [](const auto& p) { return p.p; }, {"1", "Share still there after t"});
    column(group, "low", points, [](const auto& p) { return p.low; }, {"1", "Wilson 95 % interval, low end"});
    column(group, "high", points, [](const auto& p) { return p.high; },
           {"1", "Wilson 95 % interval, high end"});
    column(group, "gone", counts.gone_in, [](std::uint64_t n) { return n; },
           {"1", "Trajectories gone after the time before and by t"});
  }
  {
    const auto points = survival_by_hits(counts);
    const Handle group =
        file.group("survival_hits", "Share of the non-singular trajectories still there after n hits");
    column(group, "n", points, [](const auto& p) { return p.n; }, {"1", "Reflections"});
    column(group, "p", points, [](const auto& p) { return p.p; }, {"1", "Share still there after n hits"});
    column(group, "low", points, [](const auto& p) { return p.low; }, {"1", "Wilson 95 % interval, low end"});
    column(group, "high", points, [](const auto& p) { return p.high; },
           {"1", "Wilson 95 % interval, high end"});
    const std::vector<std::uint64_t> gone(counts.gone_in_hits.begin(),
                                          counts.gone_in_hits.begin() + static_cast<std::ptrdiff_t>(points.size()));
    column(group, "gone", gone, [](std::uint64_t n) { return n; },
           {"1", "Trajectories gone after more hits than the number before and at most n"});
  }
  {
    const auto points = escape_rate(counts);
    const Handle group = file.group("rate", "Escape rate: -dP/dt averaged over (from, to]");
    column(group, "t", points, [](const auto& p) { return p.t; }, {"time", "Middle of the interval"});
    column(group, "from", points, [](const auto& p) { return p.from; }, {"time", "Start of the interval"});
    column(group, "to", points, [](const auto& p) { return p.to; }, {"time", "End of the interval"});
    column(group, "value", points, [](const auto& p) { return p.value; }, {"1/time", "Escape rate"});
    column(group, "low", points, [](const auto& p) { return p.low; }, {"1/time", "95 % interval, low end"});
    column(group, "high", points, [](const auto& p) { return p.high; },
           {"1/time", "95 % interval, high end"});
  }
  {
    const auto& ranges = result.done.ranges();
    const Handle group = file.group("done", "Trajectories first … last - 1 are counted here");
    column(group, "first", ranges, [](const TrajectoryRange& r) { return r.first; }, {"1", "First trajectory"});
    column(group, "last", ranges, [](const TrajectoryRange& r) { return r.last; }, {"1", "One after the last"});
  }
  if (!result.reports.empty()) {
    std::string text;
    for (const auto& [index, report] : result.reports) text += fmt::format("{}\t{}\n", index, report);
    hdf5::write_text(file.id(), "lost", text, {"text", "Index and state of the first lost trajectories"}, target);
  }
  const Handle group = file.group("fates", "Numbers of trajectories by fate");
  const auto number = [&](const char* name, std::uint64_t value, const char* text) {
    hdf5::write_column(group.get(), name, std::span<const std::uint64_t>(&value, 1), {"1", text}, target);
  };
  number("trajectories", counts.trajectories, "All trajectories");
  number("escaped", counts.escaped, "Left through a hole");
  number("survived", counts.survived, "Still there at the end");
  number("pinned", counts.pinned, "Survivors on a cyclotron orbit that never hits");
  number("capped", counts.capped, "Survivors ended by the cap on hits");
  number("singular", counts.singular, "Ended where no continuation is defined");
  number("unbounded", counts.unbounded, "No wall follows any more");
  number("lost", counts.lost, "Internal errors: always 0");
  number("collisions", counts.collisions, "Reflections of all trajectories");
  number("most_hits", counts.most_hits, "Most reflections of a single trajectory");
  if (of_discs) number("contacts", counts.contacts, "Contacts of hard discs, each pair once");
  number("digest", result.digest, "Sum of a hash of each trajectory: equal digests, equal bits");
  if (!holes.empty()) {
    const Handle dataset =
        hdf5::create_fixed(group.get(), "holes", H5T_NATIVE_UINT64, holes.size(),
                           {"1", "Escapes by hole; names in the attribute `names`"}, target);
    hdf5::write_attribute(dataset.get(), "names", holes, target);
    hdf5::check(H5Dwrite(dataset.get(), H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                         counts.hole_escapes.data()) >= 0,
                target);
  }
}

EscapeResult read_counts(hid_t file, const std::string& name) {
  const auto open = [&](const char* group) {
    Handle handle(H5Gopen2(file, group, H5P_DEFAULT), H5Gclose);
    if (!handle) throw InputError(Place{name, 0, 0, ""}, fmt::format("'{}' is missing", group), "an archive of carom escape");
    return handle;
  };
  const auto integers = [&](const Handle& group, const char* column) {
    return hdf5::read_column<std::uint64_t>(group.get(), column, name);
  };
  EscapeResult result;
  SurvivalCounts& counts = result.counts;
  const Handle survival = open("survival"), hits = open("survival_hits"), done = open("done"), fates = open("fates");
  const auto number = [&](const char* what) { return integers(fates, what).at(0); };
  std::vector<std::uint64_t> by_hole;
  if (H5Lexists(fates.get(), "holes", H5P_DEFAULT) > 0) by_hole = integers(fates, "holes");
  counts = SurvivalCounts(hdf5::read_column<double>(survival.get(), "t", name), by_hole.size());
  counts.hole_escapes = by_hole;
  counts.gone_in = integers(survival, "gone");
  const std::vector<std::uint64_t> gone_in_hits = integers(hits, "gone");
  if (counts.gone_in.size() != counts.times.size() || gone_in_hits.size() > counts.gone_in_hits.size())
    throw InputError(Place{name, 0, 0, ""}, "its columns differ in length");
  std::copy(gone_in_hits.begin(), gone_in_hits.end(), counts.gone_in_hits.begin());
  counts.trajectories = number("trajectories");
  counts.escaped = number("escaped");
  counts.survived = number("survived");
  counts.pinned = number("pinned");
  counts.capped = number("capped");
  counts.singular = number("singular");
  counts.unbounded = number("unbounded");
  counts.lost = number("lost");
  counts.collisions = number("collisions");
  counts.most_hits = number("most_hits");
  if (H5Lexists(fates.get(), "contacts", H5P_DEFAULT) > 0) counts.contacts = number("contacts");
  result.digest = number("digest");
  const auto first = integers(done, "first"), last = integers(done, "last");
  for (std::size_t i = 0; i < first.size(); ++i)
    if (!result.done.add(TrajectoryRange{first[i], last.at(i)}))
      throw InputError(Place{name, 0, 0, ""}, "it counts trajectories twice");
  if (H5Lexists(file, "lost", H5P_DEFAULT) > 0) {
    std::istringstream lines(hdf5::read_text(file, "lost", name));
    for (std::string line; std::getline(lines, line);) {
      const std::size_t tab = line.find('\t');
      if (tab == std::string::npos) continue;
      result.reports.emplace_back(std::stoull(line.substr(0, tab)), line.substr(tab + 1));
    }
  }
  return result;
}

RecordReader::RecordReader(const std::string& file) : name_(file) {
  file_ = Handle(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  const Handle group(H5Gopen2(file_.get(), "trajectories", H5P_DEFAULT), H5Gclose);
  if (!group) throw InputError(Place{file, 0, 0, ""}, "it holds no records of trajectories");
  const char* names[] = {"index", "x", "y", "vx", "vy", "fate", "hole", "t", "hits"};
  for (const char* column : names) columns_.push_back(hdf5::open_column(group.get(), column, file));
  left_ = hdf5::rows_of(columns_.front().get(), file);
}

bool RecordReader::next(std::vector<TrajectoryRecord>& records) {
  constexpr std::size_t batch = 65536;
  const std::size_t count = std::min(batch, left_);
  records.resize(count);
  if (count == 0) return false;
  const auto column = [&](std::size_t number, auto kind, auto put) {
    std::vector<decltype(kind)> values(count);
    hdf5::read_rows(columns_[number].get(), hdf5::native_type<decltype(kind)>(), row_, count, values.data(), name_);
    for (std::size_t i = 0; i < count; ++i) put(records[i], values[i]);
  };
  using Record = TrajectoryRecord;
  column(0, std::uint64_t{}, [](Record& r, std::uint64_t value) { r.index = value; });
  column(1, double{}, [](Record& r, double value) { r.x = value; });
  column(2, double{}, [](Record& r, double value) { r.y = value; });
  column(3, double{}, [](Record& r, double value) { r.vx = value; });
  column(4, double{}, [](Record& r, double value) { r.vy = value; });
  column(5, std::int32_t{}, [](Record& r, std::int32_t value) { r.fate = static_cast<Fate>(value); });
  column(6, std::int32_t{}, [](Record& r, std::int32_t value) { r.hole = value; });
  column(7, double{}, [](Record& r, double value) { r.time = value; });
  column(8, std::uint64_t{}, [](Record& r, std::uint64_t value) { r.hits = value; });
  row_ += count;
  left_ -= count;
  return true;
}

}  // namespace carom
