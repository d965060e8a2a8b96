// Archives of certified orbits: every number as its guaranteed decimals and as the double nearest
// to them.
#pragma once

#include <memory>
#include <string>

#include "carom/certify/certified_orbit.hpp"
#include "carom/io/archive.hpp"

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

}  // namespace carom
