// A look ahead in doubles: how many bits will an orbit lose?
#pragma once

#include <cstdint>

#include "certify/scene.hpp"

namespace carom::certify {

struct Forecast {
  double bits = 0.0;         ///< log2 of the largest stretch by the tangent map, relative to the start
  std::uint64_t hits = 0;    ///< as many as were followed
};

/// Follows a pseudo-orbit of doubles, which stretches as the true orbit does on average, until `most_hits` or
/// `t_max`, or until it does not know where to go.
Forecast forecast(const SceneOf<double>&, const Whereabouts&, geometry::Vector position,
                  geometry::Vector velocity, int standing, std::uint64_t most_hits, double t_max, double unit);

}  // namespace carom::certify
