// Loops that several widths of vectors make faster.
#pragma once

/// Compiled for several widths of vectors, of which the machine chooses one. All give the same
/// bits: no contraction, and sums in a fixed order.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define CAROM_VECTORISED [[gnu::target_clones("avx512f", "avx2", "default")]]
#else
#define CAROM_VECTORISED
#endif
