// fused_product in the lanes of one instruction set: included by one file for each.
#pragma once

#include "lanes/simd/fused_lanes.hpp"

namespace carom::tests {

using FuseAll = void (*)(const double* a, const double* b, const double* c, double* sums,
                         int count);
void fuse_baseline(const double* a, const double* b, const double* c, double* sums, int count);
void fuse_avx2(const double* a, const double* b, const double* c, double* sums, int count);
void fuse_avx512(const double* a, const double* b, const double* c, double* sums, int count);

namespace {

[[maybe_unused]] void fuse_all(const double* a, const double* b, const double* c, double* sums,
                               int count) {
  using Real = std::experimental::native_simd<double>;
  const auto load = [](const double* from) {
    return Real(from, std::experimental::element_aligned);
  };
  for (int i = 0; i < count; i += static_cast<int>(Real::size()))
    fused_product(load(a + i), load(b + i), load(c + i))
        .copy_to(sums + i, std::experimental::element_aligned);
}

}  // namespace
}  // namespace carom::tests
