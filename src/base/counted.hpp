// Numbers of things in words.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace carom::base {

/// "9 012 345".
std::string grouped(std::uint64_t number);
/// The noun, a word in the singular, for that many: "orbit", "orbits", "trajectories",
/// "equilibria".
std::string noun_for(std::uint64_t number, std::string_view noun);
/// "1 orbit", "9 012 orbits".
std::string counted(std::uint64_t number, std::string_view noun);

}  // namespace carom::base
