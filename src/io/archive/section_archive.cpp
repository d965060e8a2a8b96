#include <span>
#include <utility>

#include "io/archive/archive_file.hpp"
#include "io/archive/columns.hpp"
#include "io/archive/ensemble_columns.hpp"
#include "io/archive/section_numbers.hpp"
#include "io/checkpoint/ensemble_files.hpp"

namespace carom {

using namespace io;
using hdf5::Handle;

class SectionArchive::Implementation {
 public:
  Implementation(const std::string& path, const LoadedSystem& loaded, const Provenance& origin)
      : target(path),
        file(ArchiveFile::create(aside_of(path), path)),
        rows(path),
        integrated(is_integrated(loaded.system)) {
    file.write_head(section_archive_kind, loaded, origin);
    const System& system = loaded.system;
    const Handle group =
        file.group("section", "Points of the section, orbit after orbit, in order of time");
    const hid_t to = group.get();
    rows.add<std::uint64_t>(to, "orbit", {"1", "Index of the trajectory"});
    rows.add<std::uint64_t>(to, "index",
                            {"1", "Number of the point in the orbit of its particle, from 0"});
    rows.add<std::int32_t>(to, "particle", {"1", "Index of the particle"});
    const hid_t wall = rows.add<std::int32_t>(
        to, "wall", {"1", "Index into the attribute `names`, -1: not at a wall"});
    std::vector<std::string> names;
    for (const Wall& w : system.table->walls) names.push_back(w.name);
    if (!names.empty()) hdf5::write_attribute(wall, "names", names, path);
    rows.add<std::int32_t>(to, "direction", {"1", "Sense of the crossing, 1 or -1; 0 at a wall"});
    rows.add<double>(to, "t", {"time", "Time"});
    rows.add<double>(
        to, "s",
        {"length", "Length along the wall, line or circle; 0 for conditions on the velocity"});
    rows.add<double>(to, "v_parallel",
                     {"length/time", "Velocity in the direction of s; 0 likewise"});
    rows.add<double>(to, "x", {"length", "Position, unwrapped"});
    rows.add<double>(to, "y", {"length", "Position, unwrapped"});
    rows.add<double>(to, "vx", {"length/time", "Velocity, after the hit at a wall"});
    rows.add<double>(to, "vy", {"length/time", "Velocity, after the hit at a wall"});
  }

  ArchiveLock lock;
  std::string target;
  ArchiveFile file;
  hdf5::Columns rows;
  bool integrated;
};

SectionArchive::SectionArchive(const std::string& file, const LoadedSystem& loaded,
                               const Provenance& origin, bool force, ArchiveLock lock) {
  if (!lock) lock = lock_archive(file);
  refuse_existing(file, force);
  implementation_ = std::make_unique<Implementation>(file, loaded, origin);
  implementation_->lock = std::move(lock);
}
SectionArchive::~SectionArchive() = default;

void SectionArchive::append(const std::vector<SectionPoint>& points) {
  hdf5::silence();
  for (const SectionPoint& p : points)
    implementation_->rows.row(p.orbit, p.index, p.particle, p.wall, p.direction, p.t, p.s,
                              p.v_parallel, p.x, p.y, p.vx, p.vy);
}

void SectionArchive::finish(const SectionResult& result, const std::string& status) {
  Implementation& a = *implementation_;
  a.rows.close();
  {
    const Handle group = a.file.group("fates", "Numbers of orbits");
    for (const SectionNumber& number : section_numbers)
      hdf5::write_number(group.get(), number.name, result.*number.value, {"1", number.text},
                         a.target);
    write_fates(group, result, a.target);
    if (a.integrated) write_integration(group.get(), result.steps, result.energy_error, a.target);
    const Handle provenance = a.file.open_group("provenance");
    hdf5::change_attribute(provenance.get(), "threads", std::int64_t{result.threads}, a.target);
  }
  a.file.write_seconds({result.seconds, result.cpu_seconds});
  a.file.add_decisions(result.decisions);
  a.file.set_status(status, result.complete);
  a.file.keep_as(a.target);
  give_up_checkpoint(a.target);
  a.lock.reset();
}

}  // namespace carom
