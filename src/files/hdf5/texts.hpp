// Texts of variable length, which h5py reads as `str`, from files that may be damaged.
#pragma once

#include <hdf5.h>

#include <optional>
#include <string>
#include <vector>

namespace carom::files::hdf5 {

/// The texts of a dataset or an attribute; of fixed length, too. Empty where they cannot be read.
/// HDF5 keeps texts of variable length in its global heap, the only structure of a file that has no
/// checksum, and HDF5 1.10 trusts the sizes that it reads there. Carom follows the references into
/// the heap itself, within the bounds of the file. A file that is open for writing is flushed.
std::optional<std::vector<std::string>> texts_of(hid_t owner);

}  // namespace carom::files::hdf5
