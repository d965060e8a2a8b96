// The rows of finished archives.
#pragma once

#include <string>
#include <vector>

#include "carom/base/error.hpp"
#include "files/hdf5/archive_file.hpp"
#include "files/hdf5/fields.hpp"

namespace carom::files {

/// The rows of a group of an archive of this kind; InputError where it is another, or damaged.
template <class Row>
std::vector<Row> rows_of(const std::string& name, const char* kind, const char* group) {
  const hdf5::Handle file = open_kind(name, kind, std::string("the archive holds no ") + kind,
                                      std::string("an archive written by carom ") + kind);
  const hdf5::Handle rows(H5Gopen2(file.get(), group, H5P_DEFAULT), H5Gclose);
  if (!rows) throw InputError(Place{name, 0, 0, group}, "the archive is damaged");
  return read_all_rows<Row>(rows.get(), name);
}

/// Has it such a group? Archives have some only where there can be rows.
inline bool has_group(const std::string& file, const char* group) {
  return hdf5::has(open_finished(file).get(), group);
}

}  // namespace carom::files
