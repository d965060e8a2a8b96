// Fused products of two doubles side by side.
#pragma once

#include "base/pair.hpp"
#include "carom/base/fused_product.hpp"

namespace carom {

template <>
struct FusedProduct<base::Pair> {
  [[gnu::always_inline]] static base::Pair of(base::Pair a, base::Pair b, base::Pair c) {
#if defined(__x86_64__) && !defined(__FMA__)
    if (__builtin_expect(detail::fuses, 1)) {
      asm("vfmadd231pd %2, %1, %0" : "+x"(c) : "x"(a), "xm"(b));  // as of doubles
      return c;
    }
#endif
    return base::Pair{fused_product(a[0], b[0], c[0]), fused_product(a[1], b[1], c[1])};
  }
};

namespace base {

/// Does the processor fuse products itself?
inline bool fuses() { return carom::detail::fuses; }
/// For where that was asked before: the compiler does not know that the answer stays the same, and
/// would ask again at every product.
[[gnu::always_inline]] inline void fuses_surely() {
  if (!carom::detail::fuses) __builtin_unreachable();
}

}  // namespace base

}  // namespace carom
