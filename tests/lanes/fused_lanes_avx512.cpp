#include "lanes/fused_in_lanes.hpp"

namespace carom::tests {

void fuse_avx512(const double* a, const double* b, const double* c, double* sums, int count) {
  fuse_all(a, b, c, sums, count);
}

}  // namespace carom::tests
