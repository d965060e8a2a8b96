#include <utility>

#include "carom/analyses/section.hpp"
#include "files/checkpoint/ensemble_columns.hpp"
#include "files/checkpoint/work_folder.hpp"
#include "files/hdf5/archive_file.hpp"
#include "files/hdf5/fields.hpp"
#include "files/hdf5/stored_rows.hpp"

namespace carom {

using namespace files;
using hdf5::Handle;

class SectionArchive::Implementation {
 public:
  Implementation(const std::string& path, const LoadedSystem& loaded, const Provenance& origin)
      : target(path),
        file(ArchiveFile::create(aside_of(path), path)),
        rows(path),
        integrated(loaded.system.is_integrated()) {
    file.write_head(section_archive_kind, loaded, origin);
    const System& system = loaded.system;
    const Handle group =
        file.group("section", "Points of the section, orbit after orbit, in order of time");
    rows.create(group.get());
    std::vector<std::string> names;
    for (const Wall& w : system.table->walls) names.push_back(w.name);
    if (!names.empty()) hdf5::write_attribute(rows.column("wall"), "names", names, path);
  }

  ArchiveLock lock;
  std::string target;
  ArchiveFile file;
  Rows<SectionPoint> rows;
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
  for (const SectionPoint& point : points) implementation_->rows.add(point);
}

void SectionArchive::finish(const SectionResult& result, const std::string& status) {
  Implementation& a = *implementation_;
  a.rows.close();
  {
    const Handle group = a.file.group("fates", "Numbers of orbits");
    write_numbers(group.get(), result, a.target);
    write_numbers<FateCounts>(group.get(), result, a.target);
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

StoredSection read_section(const std::string& name) {
  StoredSection stored;
  stored.points = rows_of<SectionPoint>(name, section_archive_kind, "section");
  const Handle file = open_finished(name);
  const Handle fates(H5Gopen2(file.get(), "fates", H5P_DEFAULT), H5Gclose);
  SectionResult& result = stored.result;
  read_numbers(fates.get(), result, name);
  read_integration(fates.get(), name, result.steps, result.energy_error);
  result.complete = hdf5::read_attribute<std::int64_t>(file.get(), "complete", name) != 0;
  stored.system_toml = hdf5::read_text(file.get(), "system", name);
  const std::size_t particles =
      read_system(stored.system_toml, name + ": /system").system.particles.size();
  static_cast<FateCounts&>(result) = read_fates(fates, name, result.orbits * particles);
  const Handle provenance(H5Gopen2(file.get(), "provenance", H5P_DEFAULT), H5Gclose);
  stored.system_name = hdf5::read_string_attribute(provenance.get(), "system", name);
  stored.engine = hdf5::read_string_attribute(provenance.get(), "engine", name);
  const Seconds seconds = ArchiveFile::read_seconds(provenance.get(), name);
  result.seconds = seconds.wall;
  result.cpu_seconds = seconds.cpu;
  result.threads =
      static_cast<int>(hdf5::read_attribute<std::int64_t>(provenance.get(), "threads", name));
  return stored;
}

}  // namespace carom
