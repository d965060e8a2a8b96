// Isometries that map a table's walls onto themselves, and orbits that they make one.
#pragma once

#include <cstddef>
#include <vector>

#include "carom/geometry/vector.hpp"
#include "carom/orbits/periodic_orbit.hpp"
#include "orbits/boundary.hpp"

namespace carom::orbits {

/// x -> origin + R (x - origin) with R = (cosine, -sine; sine, cosine), after a mirroring of y if
/// `mirrors`.
struct Isometry {
  geometry::Vector origin;
  double cosine = 1.0, sine = 0.0;
  bool mirrors = false;
  std::vector<int> walls;                    ///< image of each wall
  geometry::Cell first{1, 0}, second{0, 1};  ///< images of the lattice's vectors

  geometry::Cell operator()(const geometry::Cell& c) const {
    return {c.first * first.first + c.second * second.first,
            c.first * first.second + c.second * second.second};
  }
  geometry::Vector operator()(geometry::Vector x) const {
    const geometry::Vector e =
        mirrors ? geometry::Vector{x.x - origin.x, origin.y - x.y} : x - origin;
    return origin + geometry::Vector{cosine * e.x - sine * e.y, sine * e.x + cosine * e.y};
  }
};

/// The isometries of the table, the identity first. Its numbers are rounded once, so a table counts
/// as symmetric where its image lies within what that rounding makes of it; nothing but the merging
/// of orbits that agree to their own errors depends on it. On a lattice those that map the walls of
/// the home cell onto themselves. The identity alone where any turn is one (a circle).
std::vector<Isometry> isometries(const Boundary&);

/// How an orbit lies on another one.
struct Match {
  std::size_t isometry = 0;  ///< index
  bool reversed = false;
  std::size_t shift = 0;  ///< the image of hit 0 is this hit of the other
};

/// All ways in which the image of `one` by a symmetry of the motion is `other`, within their
/// errors. With a field a mirror image is an orbit if it is run through in reverse; without, every
/// orbit is one in reverse. Of families the walls alone are compared, and the length.
std::vector<Match> matches(const Boundary&, const std::vector<Isometry>&, const PeriodicOrbit& one,
                           const PeriodicOrbit& other);

/// Is the orbit the same one run through several times?
bool repeats(const PeriodicOrbit&);

}  // namespace carom::orbits
