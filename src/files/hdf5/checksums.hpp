// Checksums of all that an archive holds.
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <map>
#include <string>

#include "files/hdf5/sums.hpp"

namespace carom::files::hdf5 {

/// Checksums of datasets that were taken while they were written, by path.
struct KnownSum {
  std::uint32_t sum;
  std::uint64_t count;
};
using KnownSums = std::map<std::string, KnownSum>;

/// Lists everything that the file holds in the attribute `checksums` of /provenance: a line with
/// the CRC-32 of the lines that follow, then a line for each dataset and attribute with the CRC-32
/// of its bytes, its type, number of values and path. All these have a fixed length: the attribute
/// is written again in place as long as nothing new is in the file. The bytes of a text of variable
/// length are its UTF-8 and a zero. Datasets whose sum is known are not read again.
void write_checksums(hid_t file, const std::string& name, const KnownSums& known = {});
/// Makes room for that list before readers come (SWMR): nothing can be created afterwards. The sums
/// are zeros.
void reserve_checksums(hid_t file, const std::string& name);

/// Reads everything that is listed. Throws InputError where there is no such list, and where
/// something is missing, cannot be read or is not what was written, with its path. What was added
/// to the file later is not looked at.
void verify(hid_t file, const std::string& name);

}  // namespace carom::files::hdf5
