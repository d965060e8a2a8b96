// The archive of a section.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "carom/analyses/section.hpp"
#include "carom/files/archive.hpp"

namespace carom {

/// A section as its archive holds it; times, decisions and steps are not among it.
struct StoredSection {
  std::string system_name, system_toml, engine;
  SectionResult result;
  std::vector<SectionPoint> points;
};
/// Throws InputError for anything but the archive of a section.
StoredSection read_section(const std::string& file);

/// The points of a section, orbit after orbit; written aside, and renamed when finished.
class SectionArchive {
 public:
  SectionArchive(const std::string& file, const LoadedSystem&, const Provenance&, bool force,
                 ArchiveLock = nullptr);
  SectionArchive(const SectionArchive&) = delete;
  ~SectionArchive();

  void append(const std::vector<SectionPoint>&);
  void finish(const SectionResult&, const std::string& status);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace carom
