#include "carom/base/random.hpp"

#include <Random123/philox.h>

namespace carom {

RandomStream::RandomStream(std::uint64_t seed, Purpose purpose, std::uint64_t trajectory,
                           std::uint64_t particle)
    : key_{seed, static_cast<std::uint64_t>(purpose)},
      trajectory_(trajectory),
      particle_(particle) {}

std::uint64_t RandomStream::word() {
  const std::uint64_t place = draw_ % 4;
  if (place == 0) {
    const r123::Philox4x64_R<10>::ctr_type counter = {{trajectory_, draw_ / 4, particle_, 0}};
    const r123::Philox4x64_R<10>::key_type key = {{key_[0], key_[1]}};
    const auto words = r123::Philox4x64_R<10>{}(counter, key);
    for (std::size_t i = 0; i < 4; ++i) block_[i] = words[i];
  }
  ++draw_;
  return block_[place];
}

// Every start of an ensemble draws some: each in one piece of code.
[[gnu::flatten]] double RandomStream::uniform() {
  return static_cast<double>(word() >> 11) * 0x1p-53;
}

// (2k + 1 - 2^53) 2^-53 for 0 <= k < 2^53: an odd integer below 2^53 in size, so every step is
// exact.
double RandomStream::symmetric() {
  const auto k = static_cast<std::int64_t>(word() >> 11);
  return static_cast<double>(2 * k + 1 - (std::int64_t{1} << 53)) * 0x1p-53;
}

// The test is one rounded expression without contraction, so every machine draws equally often.
[[gnu::flatten]] void RandomStream::point_in_disc(double& x, double& y) {
  do {
    x = symmetric();
    y = symmetric();
  } while (x * x + y * y >= 1.0);
}

}  // namespace carom
