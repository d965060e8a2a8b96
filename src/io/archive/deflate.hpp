// Writes the format deflate (RFC 1951) where it is known what the bytes are like.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "io/archive/prefix_code.hpp"

namespace carom::io::hdf5 {

/// Bits one after the other, the first one the lowest of a byte. Loops work on a copy: the compiler
/// keeps it in registers.
class BitWriter {
 public:
  explicit BitWriter(std::uint8_t* next) : next_(next) {}
  void put(std::uint64_t bits, std::uint32_t count) {
    held_ |= bits << used_;
    used_ += count;
  }
  void put(Bits bits) { put(bits.bits, bits.count); }
  /// Stores whole bytes. At most 56 bits may be put between two of these calls. Eight bytes are
  /// written each time; those that are not whole yet are written again.
  void spill() {
    std::uint64_t held = held_;
    if constexpr (std::endian::native == std::endian::big) held = __builtin_bswap64(held);
    std::memcpy(next_, &held, sizeof held);
    next_ += used_ / 8;
    held_ >>= used_ & ~7u;
    used_ &= 7u;
  }
  void fill_byte() {
    put(0, (8 - used_ % 8) % 8);
    spill();
  }
  /// Only where a byte begins, as after fill_byte.
  void copy(const std::uint8_t* bytes, std::size_t size) {
    std::memcpy(next_, bytes, size);
    next_ += size;
  }
  const std::uint8_t* next() const { return next_; }

 private:
  std::uint8_t* next_;
  std::uint64_t held_ = 0;  ///< bits that are not stored yet
  std::uint32_t used_ = 0;  ///< how many
};

/// A stream of zlib (RFC 1950), where it is known what is worth looking for. Each function adds
/// bytes as a block of its own, as they are where its way would not make them shorter.
class Deflate {
 public:
  /// `size`: of all bytes, less than 2^22; `parts`: how many calls there will be.
  void start(std::size_t size, std::size_t parts);
  void plain(std::span<const std::uint8_t> bytes);
  /// Frequent bytes in fewer bits.
  void literals(std::span<const std::uint8_t> bytes);
  /// The same, with copies of bytes that are often the one before.
  void runs(std::span<const std::uint8_t> bytes);
  /// The same, with copies of values of eight bytes that are often the one before but for the first
  /// and the last byte: reals whose sign or last digits change.
  void values(std::span<const std::uint8_t> bytes);
  /// `sum`: Adler-32 of all bytes. The stream is valid until the next start.
  std::span<const std::uint8_t> finish(std::uint32_t sum);

 private:
  // Symbols: literals 0 to 255, the end of a block, and lengths of what is copied.
  static constexpr std::size_t end_of_block = 256, symbols = 286;
  using Counts = std::array<std::uint32_t, symbols>;
  /// Writes the head of a block of `size` bytes as such symbols, with copies of what is `distance`
  /// bytes before, and takes the words of its code; false where plain bytes take less. `extra`:
  /// bits of the block besides the words.
  bool begin(Counts& counts, std::size_t distance, std::size_t extra, std::size_t size);

  std::vector<std::uint8_t> stream_;
  BitWriter out_{nullptr};
  std::vector<Bits> words_;            ///< of the block's code, by symbol
  std::vector<std::uint16_t> tokens_;  ///< of runs
};

}  // namespace carom::io::hdf5
