// The rows of finished archives.
#pragma once

#include <string>
#include <vector>

#include "carom/base/error.hpp"
#include "files/hdf5/archive_file.hpp"
#include "files/hdf5/checksums.hpp"
#include "files/hdf5/fields.hpp"

namespace carom::files {

/// An archive that is complete; InputError for anything else.
inline hdf5::Handle open_finished(const std::string& name) {
  hdf5::silence();
  return open_archive(name, "the file is not an archive, or it is still being written",
                      "an archive of carom");
}

/// The rows of a group of an archive of this kind; InputError where it is another, or damaged.
template <class Row>
std::vector<Row> rows_of(const std::string& name, const char* kind, const char* group) {
  const hdf5::Handle file = open_finished(name);
  if (hdf5::read_string_attribute(file.get(), "kind", name) != kind)
    throw InputError(Place{name, 0, 0, ""}, std::string("the archive holds no ") + kind,
                     std::string("an archive written by carom ") + kind);
  hdf5::verify(file.get(), name);
  const hdf5::Handle rows(H5Gopen2(file.get(), group, H5P_DEFAULT), H5Gclose);
  if (!rows) throw InputError(Place{name, 0, 0, group}, "the archive is damaged");
  return read_all_rows<Row>(rows.get(), name);
}

/// Has it such a group? Archives have some only where there can be rows.
inline bool has_group(const std::string& file, const char* group) {
  return hdf5::has(open_finished(file).get(), group);
}

}  // namespace carom::files
