// Archives of comparisons of integrators (carom compare).
#pragma once

#include <string>

#include "carom/analyses/compare.hpp"
#include "carom/files/archive.hpp"

namespace carom {

/// Writes aside and renames: the archive is there whole or not at all.
void write_comparison(const std::string& file, const LoadedSystem&, const Provenance&,
                      const Comparison&, bool force, ArchiveLock = nullptr);

/// A comparison as its archive holds it.
struct StoredComparison {
  std::string system_name, system_toml, engine;
  Comparison result;
};
/// Throws InputError for anything but the archive of a comparison.
StoredComparison read_comparison(const std::string& file);

}  // namespace carom
