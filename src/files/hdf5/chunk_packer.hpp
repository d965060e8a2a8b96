// Chunks as HDF5's filters shuffle and deflate leave them, but made for columns of numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "files/hdf5/deflate.hpp"

namespace carom::files::hdf5 {

/// The filter deflate looks for what came before anywhere, which takes longer than all the rest of
/// a run, and finds little: most bytes of reals are digits like noise. Here a look at some rows
/// tells what is worth while, and the rest is stored as it is. Any HDF5 reads the chunks.
class ChunkPacker {
 public:
  explicit ChunkPacker(DeflateLibrary library = has(DeflateLibrary::isal) ? DeflateLibrary::isal
                                                                          : DeflateLibrary::zlib)
      : deflate_(library) {}
  struct Packed {
    /// What deflate leaves. Valid until the next chunk.
    std::span<const std::uint8_t> bytes;
    /// They hold planes: a reader's filter shuffle has to put values together again.
    bool shuffled;
  };
  /// `size`: bytes of a value, 1, 2, 4 or 8; of all together less than 2^22.
  Packed pack(std::span<const std::uint8_t> values, std::size_t size);

 private:
  Deflate deflate_;
  std::vector<std::uint8_t> planes_;
};

}  // namespace carom::files::hdf5
