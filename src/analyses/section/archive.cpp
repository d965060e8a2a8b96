#include <utility>

#include "carom/analyses/section.hpp"
#include "files/checkpoint/ensemble_columns.hpp"
#include "files/hdf5/archive_file.hpp"
#include "files/hdf5/fields.hpp"
#include "files/hdf5/stored_rows.hpp"

namespace carom {

using namespace files;
using hdf5::Handle;

class SectionArchive::Implementation {
 public:
  Implementation(const std::string& path, const LoadedSystem& loaded, const Provenance& origin,
                 bool force, ArchiveLock held)
      : lock(std::move(held)),
        file(ArchiveFile::begin(section_archive_kind, path, loaded, origin, force, lock)),
        rows(path),
        integrated(loaded.system.is_integrated()) {
    const System& system = loaded.system;
    const Handle group =
        file.group("section", "Points of the section, orbit after orbit, in order of time");
    rows.create(group.get());
    std::vector<std::string> names;
    for (const Wall& w : system.table->walls) names.push_back(w.name);
    if (!names.empty()) hdf5::write_attribute(rows.column("wall"), "names", names, path);
  }

  ArchiveLock lock;  // first: it lets go last
  ArchiveFile file;
  Rows<SectionPoint> rows;
  bool integrated;
};

SectionArchive::SectionArchive(const std::string& file, const LoadedSystem& loaded,
                               const Provenance& origin, bool force, ArchiveLock lock)
    : implementation_(
          std::make_unique<Implementation>(file, loaded, origin, force, std::move(lock))) {}
SectionArchive::~SectionArchive() = default;

void SectionArchive::append(const std::vector<SectionPoint>& points) {
  hdf5::silence();
  for (const SectionPoint& point : points) implementation_->rows.add(point);
}

void SectionArchive::finish(const SectionResult& result, const std::string& status) {
  Implementation& a = *implementation_;
  const std::string& name = a.file.name();
  a.rows.close();
  {
    const Handle group = a.file.group("fates", "Numbers of orbits");
    write_numbers(group.get(), result, name);
    write_numbers<FateCounts>(group.get(), result, name);
    if (a.integrated) write_integration(group.get(), result.steps, result.energy_error, name);
    const Handle provenance = a.file.open_group("provenance");
    hdf5::change_attribute(provenance.get(), "threads", std::int64_t{result.threads}, name);
  }
  a.file.write_seconds({result.seconds, result.cpu_seconds});
  a.file.add_decisions(result.decisions);
  a.file.finish(status, result.complete);
  a.lock.reset();
}

StoredSection read_section(const std::string& name) {
  StoredSection stored;
  stored.points = rows_of<SectionPoint>(name, section_archive_kind, "section");
  const Handle file = open_finished(name);
  const Handle fates = open_group(file.get(), "fates", name);
  SectionResult& result = stored.result;
  read_numbers(fates.get(), result, name);
  read_integration(fates.get(), name, result.steps, result.energy_error);
  read_head(file.get(), name, stored, result);
  const std::size_t particles =
      read_system(stored.system_toml, name + ": /system").system.particles.size();
  static_cast<FateCounts&>(result) = read_fates(fates, name, result.orbits * particles);
  return stored;
}

}  // namespace carom
