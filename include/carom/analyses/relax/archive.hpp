// Archives of equilibria.
#pragma once

#include <string>

#include "carom/analyses/relax.hpp"
#include "carom/files/archive.hpp"

namespace carom {

/// Writes /equilibria: aside, and renamed when it is whole.
void write_equilibria(const std::string& file, const LoadedSystem&, const Provenance&,
                      const RelaxResult&, bool force, ArchiveLock = nullptr);

/// Equilibria as their archive holds them.
struct StoredEquilibria {
  std::string system_name, system_toml;
  RelaxResult result;
};
/// Throws InputError for anything but such an archive.
StoredEquilibria read_equilibria(const std::string& file);

}  // namespace carom
