// Sums of bytes that archives and the formats in them need.
#pragma once

#include <cstddef>
#include <cstdint>

namespace carom::files::hdf5 {

/// CRC-32 as zlib has it, so that others can compute it. Goes on from the sum of the bytes before.
std::uint32_t crc32(const void* bytes, std::size_t size, std::uint32_t before = 0);

/// The sum of HDF5's filter Fletcher-32, of less than 2^25 bytes.
std::uint32_t fletcher32(const void* bytes, std::size_t size);

}  // namespace carom::files::hdf5
