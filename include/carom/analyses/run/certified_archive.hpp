// Archives of certified orbits: every number as its guaranteed decimals and as the double nearest
// to them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "carom/certify/certified_orbit.hpp"
#include "carom/files/archive.hpp"

namespace carom {

/// Written aside and renamed when finished; removed when it is not.
class CertifiedArchive {
 public:
  CertifiedArchive(const std::string& file, const LoadedSystem&, const Provenance&,
                   const CertifiedTask&, bool force, ArchiveLock = nullptr);
  ~CertifiedArchive();

  void hit(const CertifiedHit&);
  void finish(const CertifiedEnd&, const CertifiedEffort&, const std::string& status,
              bool complete);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// A certified run as its archive holds it; of the task only `digits` is known.
struct StoredCertified {
  std::string system_name, system_toml;
  CertifiedTask task;
  CertifiedEnd end;
  CertifiedEffort effort;
  std::vector<CertifiedHit> hits;
};
/// Throws InputError for anything but the archive of a certified run.
StoredCertified read_certified(const std::string& file);

}  // namespace carom
