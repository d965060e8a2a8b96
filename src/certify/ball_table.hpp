// The table as it was written, at any precision: every number of the system file is enclosed anew, so
// that "0.1" is one tenth and "sqrt(3)/2" is that. Walls stand in the order of the Table.
#pragma once

#include <optional>
#include <vector>

#include "carom/table/table_spec.hpp"
#include "certify/wall.hpp"

namespace carom::certify {

/// The two vectors of a lattice.
template <class Number>
struct LatticeOf {
  VectorOf<Number> first, second;
};

struct BallTable {
  std::vector<WallOf<Ball>> walls;
  std::optional<LatticeOf<Ball>> lattice;
};

/// To the present precision. Throws InputError where a shape has no certified form.
BallTable ball_table(const TableSpec&);

WallOf<Ball> segment_wall(const BallVector& from, const BallVector& to);
/// About a given centre; counter-clockwise where the domain is inside.
WallOf<Ball> arc_wall(const BallVector& from, const BallVector& to, const BallVector& centre,
                      const Ball& radius2, bool counterclockwise);
WallOf<Ball> circle_wall(const BallVector& centre, const Ball& radius, bool counterclockwise);
WallOf<Ball> ellipse_wall(const BallVector& centre, const BallVector& axis, const Ball& ratio,
                          bool counterclockwise);

}  // namespace carom::certify
