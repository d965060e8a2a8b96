#include <optional>

#include "carom/base/error.hpp"
#include "io/archive_file.hpp"
#include "io/columns.hpp"

namespace carom {

using hdf5::Description;
using hdf5::Handle;

class EscapeArchive::Implementation {
 public:
  Implementation(const std::string& path, const LoadedSystem& loaded, const Provenance& origin,
                 bool per_trajectory)
      : target(path),
        file(ArchiveFile::create(path + ".part", path)),
        trajectories(path),
        of_discs(loaded.system.of_discs()) {
    for (const Hole& hole : loaded.system.table->holes) holes.push_back(hole.name);
    file.write_head("escape", loaded, origin);
    if (per_trajectory) create_trajectories();
  }

  void create_trajectories();
  void write_counts(const EscapeResult& result);

  template <class Points, class Get>
  void column(const Handle& group, const char* name, const Points& points, Get get, Description description) {
    std::vector<std::decay_t<decltype(get(points.front()))>> values;
    for (const auto& point : points) values.push_back(get(point));
    hdf5::write_column(group.get(), name, std::span(std::as_const(values)), description, target);
  }

  std::string target;
  ArchiveFile file;
  hdf5::Columns trajectories;
  bool of_discs;
  std::vector<std::string> holes;
};

void EscapeArchive::Implementation::create_trajectories() {
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
}

void EscapeArchive::Implementation::write_counts(const EscapeResult& result) {
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

EscapeArchive::EscapeArchive(const std::string& file, const LoadedSystem& loaded, const Provenance& origin,
                             bool force, bool per_trajectory) {
  refuse_existing(file, force);
  implementation_ = std::make_unique<Implementation>(file, loaded, origin, per_trajectory);
}
EscapeArchive::~EscapeArchive() = default;

void EscapeArchive::append(const std::vector<TrajectoryRecord>& records) {
  hdf5::silence();
  for (const TrajectoryRecord& r : records)
    implementation_->trajectories.row(r.index, r.x, r.y, r.vx, r.vy, static_cast<std::int32_t>(r.fate),
                                      r.hole, r.time, r.hits);
}

void EscapeArchive::finish(const EscapeResult& result, const std::string& status) {
  Implementation& a = *implementation_;
  a.trajectories.close();
  a.write_counts(result);
  const Handle provenance = a.file.open_group("provenance");
  hdf5::change_attribute(provenance.get(), "threads", std::int64_t{result.threads}, a.target);
  a.file.add_decisions(result.decisions);
  a.file.set_status(status, result.complete);
  a.file.keep_as(a.target);
}

}  // namespace carom
