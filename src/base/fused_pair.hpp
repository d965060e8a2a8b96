// Fused products of two doubles side by side.
#pragma once

#include "base/pair.hpp"
#include "carom/base/fused_product.hpp"

template <>
struct carom::FusedProduct<carom::base::Pair> {
  using Pair = base::Pair;
  [[gnu::always_inline]] static Pair of(Pair a, Pair b, Pair c) {
#if defined(__x86_64__) && !defined(__FMA__)
    if (__builtin_expect(detail::fuses, 1)) {
      asm("vfmadd231pd %2, %1, %0" : "+x"(c) : "x"(a), "xm"(b));  // as of doubles
      return c;
    }
#endif
    return Pair{fused_product(a[0], b[0], c[0]), fused_product(a[1], b[1], c[1])};
  }
};

namespace carom::base {

/// Does the processor fuse products itself?
inline bool fuses() { return carom::detail::fuses; }
/// For where that was asked before: the compiler does not know that the answer stays the same, and
/// would ask again at every product.
[[gnu::always_inline]] inline void fuses_surely() {
  if (!carom::detail::fuses) __builtin_unreachable();
}

}  // namespace carom::base
