// What emscripten's C++ library, libc++ 13, lacks of C++20. Included before everything else.
#pragma once
#if defined(__cplusplus)

#include <algorithm>
#include <charconv>

namespace std {

template <class To, class From>
constexpr To bit_cast(const From& from) {
  return __builtin_bit_cast(To, from);
}

namespace ranges {
template <class Range, class Predicate>
bool none_of(const Range& range, Predicate predicate) {
  return std::none_of(range.begin(), range.end(), predicate);
}
}  // namespace ranges

to_chars_result to_chars(char* begin, char* end, double x, chars_format, int precision);
to_chars_result to_chars(char* begin, char* end, double x);

}  // namespace std

#endif
