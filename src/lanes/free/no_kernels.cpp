#include "lanes/free/kernels.hpp"

namespace carom::lanes {

namespace {

void leave_all(const LaneTable&, LanePack& pack) {
  pack.calls = 0;
  for (int i = 0; i < pack.used; ++i) {
    pack.born[i] += 1.0;
    if (!(pack.active[i] > 0.0)) continue;
    pack.lane[pack.calls] = i;
    pack.call[pack.calls++] = Call::undecided;
  }
  pack.sweep += 1.0;
}

}  // namespace

Kernels no_kernels() { return {leave_all, leave_all, 1}; }

}  // namespace carom::lanes
