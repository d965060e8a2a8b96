#include "files/hdf5/sums.hpp"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstring>
#ifdef CAROM_ISAL
#include <isa-l/crc.h>
#endif

namespace carom::files::hdf5 {

std::uint32_t crc32(const void* bytes, std::size_t size, std::uint32_t before) {
  const auto* const at = static_cast<const unsigned char*>(bytes);
#ifdef CAROM_ISAL
  return crc32_gzip_refl(before, at, size);
#else
  return static_cast<std::uint32_t>(crc32_z(before, at, size));
#endif
}

// With the words w_0 ... w_{n-1} of two bytes, the higher first, the two halves are the sums of w_i
// and of (n - i) w_i modulo 65535, where 0 means words that are all 0, and 65535 means other
// multiples. Words are taken with the lower byte first, two sums a register: 256 times these are
// those wanted. Eight bytes at a time: the k-th of m groups counts 4 (m - k) - r in its word r. The
// last group may have zeros after it, of which whole words count nothing.
std::uint32_t fletcher32(const void* bytes, std::size_t size) {
  constexpr std::uint64_t halves = 0x0000ffff0000ffffu;
  constexpr std::size_t most = 256;           // groups until sums of sums might leave 32 bits
  std::uint64_t words[4] = {}, weighted = 0;  // of what was done
  const auto take = [&](const unsigned char* at, std::size_t groups) {
    while (groups > 0) {
      const std::size_t now = std::min(most, groups);
      std::uint64_t even = 0, odd = 0, evens = 0, odds = 0;
      for (std::size_t i = 0; i < now; ++i, at += 8) {
        std::uint64_t eight = 0;
        std::memcpy(&eight, at, 8);
        if constexpr (std::endian::native == std::endian::big) eight = __builtin_bswap64(eight);
        even += eight & halves;
        odd += eight >> 16 & halves;
        evens += even;
        odds += odd;
      }
      const auto low = [](std::uint64_t x) { return x & 0xffffffffu; };
      // What came before counts once more for each group that follows.
      weighted += now * (words[0] + words[1] + words[2] + words[3]) + low(evens) + low(odds) +
                  (evens >> 32) + (odds >> 32);
      words[0] += low(even), words[1] += low(odd), words[2] += even >> 32, words[3] += odd >> 32;
      groups -= now;
    }
  };
  const auto* at = static_cast<const unsigned char*>(bytes);
  const std::size_t rest = size % 8, missing = rest == 0 ? 0 : (8 - rest) / 2;
  take(at, size / 8);
  if (rest > 0) {
    unsigned char last[8] = {};
    std::memcpy(last, at + (size - rest), rest);
    take(last, 1);
  }
  const std::uint64_t sum = words[0] + words[1] + words[2] + words[3];
  const std::uint64_t sums = 4 * weighted - words[1] - 2 * words[2] - 3 * words[3] - missing * sum;
  const auto reduced = [](std::uint64_t x) {
    return x == 0 ? std::uint32_t{0}
                  : static_cast<std::uint32_t>((x % 65535 * 256 + 65534) % 65535 + 1);
  };
  return reduced(sums) << 16 | reduced(sum);
}

}  // namespace carom::files::hdf5
