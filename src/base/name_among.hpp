// Names of enumerators, in their order.
#pragma once

#include <cstddef>

namespace carom::base {

/// The name of `value`, of which `last` is the last enumerator; its name for what is none.
template <auto last, std::size_t n>
constexpr const char* name_among(const char* const (&names)[n], decltype(last) value) {
  static_assert(n == static_cast<std::size_t>(last) + 1);
  const auto i = static_cast<std::size_t>(value);
  return names[i < n ? i : n - 1];
}

}  // namespace carom::base
