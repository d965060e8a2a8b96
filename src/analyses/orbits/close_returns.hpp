// Orbits that nearly close, as starts of a search for periodic ones.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "carom/system/system.hpp"
#include "orbits/chain.hpp"

namespace carom::analyses {

struct CloseReturnPlan {
  std::size_t fewest_hits = 2, most_hits = 0;
  std::uint64_t starts = 0;
  std::uint64_t tries = 0;  ///< chains for each number of hits
  std::function<void(std::uint64_t flown, std::uint64_t starts)> progress = {};
};

/// The closest recurrences of trajectories that start on the walls with the cosine law, after so
/// many hits. Where they go round different walls, all sequences of walls have their turn.
std::vector<orbits::Chain> close_returns(const System&, const orbits::Boundary&,
                                         const CloseReturnPlan&,
                                         const std::function<bool()>& stopped);

}  // namespace carom::analyses
