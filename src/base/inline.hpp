// Small functions that a hot loop cannot do without: inlined also where the compiler counts them
// too long.
#pragma once

#define CAROM_INLINE [[gnu::always_inline]] inline
