#include "carom/analysis/fate_counts.hpp"

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

void FateCounts::add_fates(const FateCounts& other) {
  survived += other.survived;
  pinned += other.pinned;
  capped += other.capped;
  escaped += other.escaped;
  singular += other.singular;
  unbounded += other.unbounded;
  unresolved += other.unresolved;
  lost += other.lost;
}

}  // namespace carom
