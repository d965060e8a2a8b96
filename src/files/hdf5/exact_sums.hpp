// Exact sums as datasets, with all their digits.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "carom/base/exact_sum.hpp"
#include "files/hdf5/hdf5.hpp"

namespace carom::files {

/// Of each sum the digits from the lowest to the highest that any of them has, so equal sums make
/// equal datasets.
void write_sums(const hdf5::Handle& group, const char* name,
                const std::vector<const ExactSum*>& sums, hdf5::Description,
                const std::string& file);
/// `count` of them; `path` names the group in messages. Throws InputError where digits are missing.
std::vector<ExactSum> read_sums(const hdf5::Handle& group, const std::string& path,
                                const char* name, std::size_t count, const std::string& file);

}  // namespace carom::files
