// Lengths of free flights as datasets.
#pragma once

#include <string>

#include "carom/analysis/free_paths.hpp"
#include "io/archive/archive_file.hpp"

namespace carom::io {

/// Nothing where none were counted.
void write_free_paths(const ArchiveFile&, const FreePathSums&);
/// Of an archive without them the sums of none.
FreePathSums read_free_paths(hid_t file, const std::string& name);

}  // namespace carom::io
