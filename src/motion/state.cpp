#include "carom/motion/state.hpp"

namespace carom {

const char* name_of(Fate fate) {
  switch (fate) {
    case Fate::survived:
      return "survived";
    case Fate::pinned:
      return "pinned";
    case Fate::capped:
      return "capped";
    case Fate::escaped:
      return "escaped";
    case Fate::singular:
      return "singular";
    case Fate::unbounded:
      return "unbounded";
    case Fate::lost:
      return "lost";
    case Fate::unresolved:
      return "unresolved";
  }
  return "lost";
}

}  // namespace carom
