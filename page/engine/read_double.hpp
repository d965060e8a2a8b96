// What libc++ 13 lacks, for the one file that asks for it.
#pragma once

#include <charconv>

namespace std {

from_chars_result from_chars(const char* begin, const char* end, double& x,
                             chars_format = chars_format::general);

/// Named, but never called.
to_chars_result to_chars(char* begin, char* end, double x, chars_format);

}  // namespace std
