// Chunks as HDF5's filters shuffle and deflate leave them, but made for columns of numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "io/archive/deflate.hpp"

namespace carom::io::hdf5 {

/// The filter deflate looks for what came before anywhere, which takes longer than all the rest of
/// a run, and finds little: most bytes of reals are digits like noise. Here a look at some rows
/// tells what is worth while, and the rest is stored as it is. Any HDF5 reads the chunks.
class ChunkPacker {
 public:
  struct Packed {
    /// What deflate leaves. Valid until the next chunk.
    std::span<const std::uint8_t> bytes;
    /// By shuffle before; else deflate alone makes the chunk.
    bool shuffled;
  };
  /// `size`: bytes of a value, at most 8; all together at most 2^22.
  Packed pack(std::span<const std::uint8_t> values, std::size_t size);

 private:
  Deflate deflate_;
  std::vector<std::uint8_t> planes_;
};

}  // namespace carom::io::hdf5
