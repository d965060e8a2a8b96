#include "carom/motion/state.hpp"

#include "base/name_among.hpp"

namespace carom {

const char* name_of(Fate fate) {
  return base::name_among<last_fate>(
      {"survived", "pinned", "capped", "escaped", "singular", "unbounded", "lost", "unresolved"},
      fate);
}

}  // namespace carom
