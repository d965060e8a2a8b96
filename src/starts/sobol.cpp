#include "starts/sobol.hpp"

#include <bit>

#include "carom/base/random.hpp"

namespace carom::starts {

namespace {

constexpr int digits = Sobol::digits;
using Columns = std::array<std::uint64_t, digits>;

// Column k is m_k 2^-k as a fraction of 53 digits. The numbers m_k are odd and below 2^k; those of
// the primitive polynomials x + 1 and x^2 + x + 1 follow from the first one and two.
Columns directions(int dimension) {
  Columns m{};
  for (std::size_t k = 0; k < m.size(); ++k) {
    if (dimension == 0)
      m[k] = 1;
    else if (dimension == 1)
      m[k] = k == 0 ? 1 : 2 * m[k - 1] ^ m[k - 1];
    else
      m[k] = k == 0 ? 1 : k == 1 ? 3 : 2 * m[k - 1] ^ 4 * m[k - 2] ^ m[k - 2];
  }
  for (std::size_t k = 0; k < m.size(); ++k) m[k] <<= digits - 1 - static_cast<int>(k);
  return m;
}

}  // namespace

Sobol::Sobol(std::uint64_t seed, std::uint64_t replicate) {
  for (int d = 0; d < dimensions; ++d) {
    RandomStream random(seed, Purpose::quasi_random, replicate, static_cast<std::uint64_t>(d));
    Dimension& mine = by_dimension_[static_cast<std::size_t>(d)];
    const Columns plain = directions(d);
    // A digit of the result is that digit, plus a random sum of those before it.
    for (int bit = digits - 1; bit >= 0; --bit) {
      const std::uint64_t own = std::uint64_t{1} << bit;
      const std::uint64_t row = (random.word() >> (64 - digits) & ~(2 * own - 1)) | own;
      for (std::size_t k = 0; k < plain.size(); ++k)
        if (std::popcount(row & plain[k]) % 2 == 1) mine.columns[k] |= own;
    }
    mine.shift = random.word() >> (64 - digits);
  }
}

Sobol::Point Sobol::point(std::uint64_t index) const {
  Point at{};
  for (std::size_t d = 0; d < at.size(); ++d) {
    std::uint64_t sum = by_dimension_[d].shift;
    for (std::uint64_t rest = index; rest != 0; rest &= rest - 1)
      sum ^= by_dimension_[d].columns[static_cast<std::size_t>(std::countr_zero(rest))];
    at[d] = static_cast<double>(sum) * 0x1p-53;
  }
  return at;
}

}  // namespace carom::starts
