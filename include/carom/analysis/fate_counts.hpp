// How many particles of an ensemble ended in which way.
#pragma once

#include <cstdint>

#include "carom/motion/state.hpp"

namespace carom {

struct FateCounts {
  std::uint64_t survived = 0;   ///< those that are pinned included
  std::uint64_t escaped = 0;    ///< through a hole, or to infinity
  std::uint64_t unbounded = 0;  ///< of those, to infinity: no wall follows any more
  std::uint64_t pinned = 0, capped = 0, singular = 0, unresolved = 0, lost = 0;

  void count(Fate);
  void add_fates(const FateCounts&);
};

}  // namespace carom
