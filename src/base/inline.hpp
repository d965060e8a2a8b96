// Small functions that a hot loop cannot do without: inlined also where the compiler counts them
// too long.
#pragma once

#define CAROM_INLINE [[gnu::always_inline]] inline

/// Compiled for several widths of vectors, of which the machine chooses one. All give the same
/// bits: no contraction, and sums in a fixed order.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define CAROM_VECTORISED [[gnu::target_clones("avx512f", "avx2", "default")]]
#else
#define CAROM_VECTORISED
#endif
