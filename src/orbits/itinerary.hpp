// Cyclic words of walls, and chains of hits for Newton's method to begin with.
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

/// The chain with its hits moved along their walls until its length is least, as far as the
/// minimisation gets (GSL's BFGS): nearly an orbit, for Newton's method to end. Between convex
/// separate walls there is one shortest chain of each word.
Chain shortest(const Boundary&, const Chain&);

}  // namespace carom::orbits
