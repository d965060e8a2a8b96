// How many particles of an ensemble ended in which way.
#pragma once

#include <cstdint>

#include "carom/motion/state.hpp"

namespace carom {

/// (1) all() == survived + escaped + singular + unresolved + lost: each particle is in one of them
/// (2) pinned and capped ones are among those that survived, unbounded ones among the escaped
struct FateCounts {
  std::uint64_t survived = 0;   ///< still there at the end
  std::uint64_t pinned = 0;     ///< of those, on a cyclotron orbit that never hits
  std::uint64_t capped = 0;     ///< of those, ended by the cap on hits
  std::uint64_t escaped = 0;    ///< through a hole, or to infinity
  std::uint64_t unbounded = 0;  ///< of those, to infinity: no wall follows any more
  std::uint64_t singular = 0, unresolved = 0, lost = 0;

  void count(Fate);
  void add_fates(const FateCounts&);
  /// Particles that were counted.
  std::uint64_t all() const { return survived + escaped + singular + unresolved + lost; }
  /// Those that were followed until the last time: survivors that no cap ended.
  std::uint64_t until_last_time() const { return survived - capped; }
};

}  // namespace carom
