#include "carom/results/fate_counts.hpp"

namespace carom {

void FateCounts::count(Fate fate) {
  switch (fate) {
    case Fate::survived:
      ++survived;
      return;
    case Fate::pinned:
      ++pinned;
      ++survived;
      return;
    case Fate::capped:
      ++capped;
      ++survived;
      return;
    case Fate::escaped:
      ++escaped;
      return;
    case Fate::singular:
      ++singular;
      return;
    case Fate::unbounded:
      ++unbounded;
      ++escaped;
      return;
    case Fate::unresolved:
      ++unresolved;
      return;
    case Fate::lost:
      ++lost;
      return;
  }
}

}  // namespace carom
