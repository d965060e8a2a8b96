// A look ahead in doubles: how many bits will an orbit lose?
#pragma once

#include <cstdint>
#include <functional>

#include "certify/flight/scene.hpp"

namespace carom::certify {

struct Forecast {
  double bits = 0.0;    ///< log2 of the largest stretch by the tangent map, relative to the start
  double spread = 0.0;  ///< by how much another orbit's may differ: a standard deviation
  std::uint64_t hits = 0;  ///< as many as were followed
  double time = 0.0;       ///< after these
  double cells = 0.0;      ///< lattice vectors from the start's cell, then
};

/// When to end a look ahead.
struct Horizon {
  std::uint64_t hits = 0;
  double t_max = 0.0;
  double bits = 0.0;
  const std::function<bool()>* interrupted = nullptr;
};

/// Follows a pseudo-orbit of doubles, which stretches as the true orbit does on average, up to the
/// horizon, or until it does not know where to go.
Forecast forecast(const SceneOf<double>&, const Whereabouts&, geometry::Vector position,
                  geometry::Vector velocity, int standing, const Horizon&, double unit);

}  // namespace carom::certify
