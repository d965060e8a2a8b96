#include <span>
#include <utility>

#include "ensemble/describe/ends.hpp"
#include "io/archive/archive_file.hpp"
#include "io/archive/ensemble_columns.hpp"
#include "io/archive/fields.hpp"
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
        integrated(ensemble::is_integrated(loaded.system)) {
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

}  // namespace carom
