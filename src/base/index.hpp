// Indices that stay `int`, as walls and particles have -1 for none, for containers.
#pragma once

#include <cstddef>

namespace carom::base {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace carom::base
