#include "carom/base/random.hpp"

#include <Random123/philox.h>

namespace carom {

// Every start of an ensemble draws some: in one piece of code.
[[gnu::flatten]] void RandomStream::block(std::uint64_t seed, Purpose purpose,
                                          std::uint64_t trajectory, std::uint64_t particle,
                                          std::uint64_t number, Block& words) {
  const r123::Philox4x64_R<10>::ctr_type counter = {{trajectory, number, particle, 0}};
  const r123::Philox4x64_R<10>::key_type key = {{seed, static_cast<std::uint64_t>(purpose)}};
  const auto made = r123::Philox4x64_R<10>{}(counter, key);
  for (std::size_t i = 0; i < 4; ++i) words[i] = made[i];
}

RandomStream::RandomStream(std::uint64_t seed, Purpose purpose, std::uint64_t trajectory,
                           std::uint64_t particle, std::uint64_t first)
    : seed_(seed),
      purpose_(purpose),
      trajectory_(trajectory),
      particle_(particle),
      draw_(4 * first) {}

std::uint64_t RandomStream::word() {
  const std::uint64_t place = draw_ % 4;
  if (place == 0) block(seed_, purpose_, trajectory_, particle_, draw_ / 4, block_);
  ++draw_;
  return block_[place];
}

}  // namespace carom
