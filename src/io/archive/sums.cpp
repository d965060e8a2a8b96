#include "io/archive/sums.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "base/vectorised.hpp"

#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>
#define CAROM_FOLDS
#endif

namespace carom::io::hdf5 {

namespace {

// Eight bytes at a time: tables[k][b] is what the byte b adds when k bytes follow it.
using Tables = std::array<std::array<std::uint32_t, 256>, 8>;
constexpr Tables make_tables() {
  Tables tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t sum = byte;
    for (int bit = 0; bit < 8; ++bit) sum = (sum >> 1) ^ ((sum & 1u) != 0 ? 0xedb88320u : 0u);
    tables[0][byte] = sum;
  }
  for (std::size_t k = 1; k < tables.size(); ++k)
    for (std::size_t byte = 0; byte < 256; ++byte)
      tables[k][byte] = (tables[k - 1][byte] >> 8) ^ tables[0][tables[k - 1][byte] & 0xffu];
  return tables;
}
constexpr Tables tables = make_tables();

std::uint32_t after_eight(std::uint32_t sum, const unsigned char* at) {
  const std::uint32_t first = sum ^ (at[0] | at[1] << 8 | at[2] << 16 | std::uint32_t{at[3]} << 24);
  return tables[7][first & 0xffu] ^ tables[6][first >> 8 & 0xffu] ^ tables[5][first >> 16 & 0xffu] ^
         tables[4][first >> 24] ^ tables[3][at[4]] ^ tables[2][at[5]] ^ tables[1][at[6]] ^
         tables[0][at[7]];
}

#ifdef CAROM_FOLDS
// x^n modulo the polynomial; bit 31 is the coefficient of x^0, as in all of these sums.
constexpr std::uint32_t power(int n) {
  std::uint32_t x = 0x80000000u;
  for (; n > 0; --n) x = x >> 1 ^ ((x & 1u) != 0 ? 0xedb88320u : 0u);
  return x;
}

// 16 bytes are A x^64 + B, with the first eight in A. Moved on by n bits they are A x^(n + 64) +
// B x^n, and so are remainders of these powers, of 32 bits, with A and B as factors (Gopal et al.,
// "Fast CRC computation for generic polynomials using PCLMULQDQ", Intel 2009). A product of two
// times 64 bits in this order is one of x too many; a factor of 32 bits stands 32 places too low.
[[gnu::target("pclmul")]] __m128i moved(__m128i bytes, __m128i by) {
  return _mm_xor_si128(_mm_clmulepi64_si128(bytes, by, 0x00),
                       _mm_clmulepi64_si128(bytes, by, 0x11));
}
__m128i mover(int bits) {
  return _mm_set_epi64x(static_cast<long long>(std::uint64_t{power(bits - 32)} << 1),
                        static_cast<long long>(std::uint64_t{power(bits + 32)} << 1));
}

// 16 bytes with the same remainder as `sum` and `count` times 64 bytes.
[[gnu::target("pclmul")]] std::array<unsigned char, 16> folded(const unsigned char* at,
                                                               std::size_t count,
                                                               std::uint32_t sum) {
  const __m128i far = mover(512), near = mover(128);
  const auto load = [&](std::size_t k) {
    return _mm_loadu_si128(reinterpret_cast<const __m128i*>(at + 16 * k));
  };
  __m128i a = _mm_xor_si128(load(0), _mm_cvtsi32_si128(static_cast<int>(sum))), b = load(1),
          c = load(2), d = load(3);
  for (; count > 1; --count) {
    at += 64;
    a = _mm_xor_si128(moved(a, far), load(0));
    b = _mm_xor_si128(moved(b, far), load(1));
    c = _mm_xor_si128(moved(c, far), load(2));
    d = _mm_xor_si128(moved(d, far), load(3));
  }
  b = _mm_xor_si128(moved(a, near), b);
  c = _mm_xor_si128(moved(b, near), c);
  d = _mm_xor_si128(moved(c, near), d);
  std::array<unsigned char, 16> rest{};
  std::memcpy(rest.data(), &d, sizeof d);
  return rest;
}
#endif

std::uint32_t one_by_one(const unsigned char* at, std::size_t size, std::uint32_t sum) {
  for (; size >= 8; size -= 8, at += 8) sum = after_eight(sum, at);
  for (; size > 0; --size, ++at) sum = sum >> 8 ^ tables[0][(sum ^ *at) & 0xffu];
  return sum;
}

// Weights of bytes, the last of which counts once. More of them would overflow a sum of 32 bits.
constexpr std::size_t weights = 4096;
static_assert(255 * weights * (weights + 1) / 2 < std::size_t{1} << 31);
constexpr auto falling = [] {
  std::array<std::int16_t, weights> made{};
  for (std::size_t i = 0; i < weights; ++i) made[i] = static_cast<std::int16_t>(weights - i);
  return made;
}();

struct Both {
  std::int32_t sum, weighted;
};
CAROM_VECTORISED Both both_sums(const unsigned char* at, std::size_t size) {
  const std::int16_t* weight = falling.data() + (weights - size);
  std::int32_t sum = 0, weighted = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const std::int16_t byte = at[i];
    sum += byte;
    weighted += byte * weight[i];
  }
  return {sum, weighted};
}

}  // namespace

std::uint32_t crc32(const void* bytes, std::size_t size, std::uint32_t before) {
  const auto* at = static_cast<const unsigned char*>(bytes);
  std::uint32_t sum = ~before;
#ifdef CAROM_FOLDS
  static const bool folds = __builtin_cpu_supports("pclmul") != 0;
  if (const std::size_t count = size / 64; folds && count > 0) {
    const auto rest = folded(at, count, sum);
    sum = one_by_one(rest.data(), rest.size(), 0);
    at += 64 * count;
    size -= 64 * count;
  }
#endif
  return ~one_by_one(at, size, sum);
}

// Two sums modulo 65521: of the bytes and one, and of all values that the first one has had.
std::uint32_t adler32(const void* bytes, std::size_t size) {
  constexpr std::uint64_t modulus = 65521;
  std::uint64_t sum = 1, sums = 0;
  for (const auto* at = static_cast<const unsigned char*>(bytes); size > 0;) {
    const std::size_t now = std::min(size, weights);
    const Both more = both_sums(at, now);
    sums = (sums + now * sum + static_cast<std::uint64_t>(more.weighted)) % modulus;
    sum = (sum + static_cast<std::uint64_t>(more.sum)) % modulus;
    at += now;
    size -= now;
  }
  return static_cast<std::uint32_t>(sums << 16 | sum);
}

// With the words w_0 ... w_{n-1} of two bytes, the higher first, the two halves are the sums of w_i
// and of (n - i) w_i modulo 65535, of which 0 stands for words that are all 0 and 65535 for other
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

}  // namespace carom::io::hdf5
