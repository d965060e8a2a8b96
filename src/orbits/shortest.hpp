// The second way to orbits without field: the shortest chain.
#pragma once

#include "orbits/chain.hpp"

namespace carom::orbits {

/// The chain with its hits moved along their walls until its length is least, as far as the
/// minimisation gets (GSL's BFGS): nearly an orbit, for Newton's method to end. Between convex
/// separate walls there is one shortest chain of each word.
Chain shortest(const Boundary&, const Chain&);

}  // namespace carom::orbits
