// How many particles of an ensemble ended in which way.
#pragma once

#include <cstdint>

#include "carom/motion/state.hpp"

namespace carom {

struct FateCounts {
  std::uint64_t survived = 0;  ///< those that are pinned included
  std::uint64_t pinned = 0, capped = 0, escaped = 0, singular = 0, unbounded = 0, unresolved = 0,
                lost = 0;

  void count(Fate);
  void add_fates(const FateCounts&);
};

}  // namespace carom
