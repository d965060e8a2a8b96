// fused_product in the lanes of one instruction set: included by one file for each.
#pragma once

#include "lanes/simd/real.hpp"

namespace carom::tests {

using FuseAll = void (*)(const double* a, const double* b, const double* c, double* sums,
                         int count);
void fuse_baseline(const double* a, const double* b, const double* c, double* sums, int count);
void fuse_avx2(const double* a, const double* b, const double* c, double* sums, int count);
void fuse_avx512(const double* a, const double* b, const double* c, double* sums, int count);

namespace {

[[maybe_unused]] void fuse_all(const double* a, const double* b, const double* c, double* sums,
                               int count) {
  using namespace lanes;
  for (int i = 0; i < count; i += width)
    store(fused_product(load(a + i), load(b + i), load(c + i)), sums + i);
}

}  // namespace
}  // namespace carom::tests
