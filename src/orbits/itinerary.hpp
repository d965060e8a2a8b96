// Cyclic words of walls.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "orbits/chain.hpp"

namespace carom::orbits {

/// Every prime cyclic word of `length` letters out of `letters`, without equal neighbours, once:
/// its least rotation. False: `each` said no.
bool for_each_word(int letters, std::size_t length,
                   const std::function<bool(const std::vector<int>&)>& each);

/// Initial guess for an itinerary: one hit per disc, on the side facing its neighbours. With a
/// field each flight is the shorter arc; empty where no arc is so long.
Chain chain_of_word(const Boundary&, const std::vector<int>& word);

}  // namespace carom::orbits
