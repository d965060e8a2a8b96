// The region that closed loops of curves bound: is it one, and how large.
//
// Laws, each a test:
// (1) every answer is exact: it is a statement about the doubles as they are;
// (2) the order of loops, and where a loop starts, change no answer;
// (3) a loop reversed is a fault; a region moved by a lattice vector is the same region.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "carom/geometry/curve.hpp"
#include "carom/geometry/lattice.hpp"

namespace carom::geometry {

/// A curve under the name that faults call it by.
struct NamedCurve {
  std::string name;
  Curve curve;
};

/// Each curve starts where the one before ends, the first where the last ends. A full circle or
/// ellipse is a loop by itself.
using Loop = std::vector<NamedCurve>;

enum class RegionKind {
  bounded,  ///< one counter-clockwise loop, with clockwise obstacles inside
  open,     ///< clockwise obstacles in the plane
  lattice,  ///< clockwise obstacles, repeated by a lattice
};

/// What keeps curves from bounding a region, with the names of the culprits and the place.
struct RegionFault {
  enum class Kind {
    no_extent,    ///< a curve without length, radius, axis or ratio, or with a number not finite
    open_loop,    ///< a curve does not start where the one before ends
    crossing,     ///< two curves cross, meet at a joint, or run along each other
    orientation,  ///< the wrong way round
    nesting,      ///< an obstacle outside the outer loop or within another obstacle
  } kind;
  std::string first, second;  ///< names of the curves; second may be empty
  Vector place;               ///< rounded
  std::string sentence;       ///< e.g. "walls 'left' and 'cap' cross near (0.31, 1.2)"
};

/// What is wrong with the region, at most `limit` faults; none if it is sound. Obstacles may touch
/// each other and the outer loop at single points (cusps). Loops that cross are not asked for their
/// nesting.
std::vector<RegionFault> check_region(const std::vector<Loop>& loops, RegionKind kind,
                                      const std::optional<Lattice>& lattice = std::nullopt,
                                      std::size_t limit = 10);

/// Exact point location with respect to one loop: positive inside (or on the left), negative
/// outside, zero on it. The loop must be closed and simple.
int locate(const Loop& loop, Vector point);
/// Exact: is a loop inside another one that it does not cross?
bool lies_inside(const Loop& loop, const Loop& around);
/// Exact, of a loop that is closed and simple.
bool runs_counterclockwise(const Loop& loop);
/// Exact: is the point one of the curve?
bool passes_through(const Curve&, Vector point);

/// Signed area and total length, rounded: obstacles count negative.
double area(const std::vector<Loop>& loops);
double perimeter(const std::vector<Loop>& loops);

}  // namespace carom::geometry
