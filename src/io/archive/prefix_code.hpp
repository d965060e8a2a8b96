// Prefix codes as the format deflate has them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace carom::io::hdf5 {

/// Bits and how many they are; the first to be written is the lowest.
struct Bits {
  std::uint32_t bits = 0;
  std::uint32_t count = 0;
};

/// Lengths of the words of a prefix code for symbols that occur so often: the least in sum (Huffman
/// 1952), or little more where a word would be longer than `longest`. Symbols that do not occur
/// have length 0. At least two must occur, at most 2^`longest`, each less than 2^22 times.
std::vector<std::uint8_t> code_lengths(std::span<const std::uint32_t> counts, unsigned longest);

/// The words that RFC 1951 (section 3.2.2) gives to these lengths.
std::vector<Bits> code_words(std::span<const std::uint8_t> lengths);

}  // namespace carom::io::hdf5
