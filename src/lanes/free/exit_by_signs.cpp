#include "lanes/free/exit_by_signs.hpp"

#include <algorithm>
#include <cmath>

namespace carom::lanes {

using geometry::Vector;

namespace {

/// Is a joint inside the cap between an arc and its chord? A flight within a cap meets its arc
/// again. One within 2^-40 S of the chord is not: no line that keeps 2^-36 S from all joints passes
/// between it and both ends.
bool in_cap(const LaneTable& t, int arc, int end, int joint) {
  const Vector a{t.joint_x[arc], t.joint_y[arc]}, b{t.joint_x[end], t.joint_y[end]},
      q{t.joint_x[joint], t.joint_y[joint]};
  const Vector e = q - Vector{t.point_x[arc], t.point_y[arc]};
  const bool beyond_chord = cross(b - a, q - a) < -0x1p-40 * t.size * std::sqrt(dot(b - a, b - a));
  return beyond_chord && std::sqrt(dot(e, e)) < t.radius[arc] + 0x1p-40 * t.size;
}

}  // namespace

void prepare_exits(LaneTable& t) {
  if (t.convex || t.open || t.edges > 0 || t.ellipses.any || t.pieces > LaneTable::most_signs)
    return;
  for (int loop = 0; loop < t.loops; ++loop) {
    const int first = t.first[loop], end = first + t.count[loop];
    for (int i = first; i < end; ++i) {
      if (t.closed[i] || t.orientation[i] < 0.0) return;
      const int next = i + 1 < end ? i + 1 : first;
      for (int joint = 0; t.bent[i] && joint < t.pieces; ++joint)
        if (joint != i && joint != next && in_cap(t, i, next, joint)) return;
    }
  }
  t.by_signs = true;
  std::fill_n(t.exit, sizeof t.exit, LaneTable::unknown);
}

int entry_of(const LaneTable& t, int start, Vector position, Vector velocity, double margin) {
  int entry = start << t.pieces;
  for (int i = 0; i < t.pieces; ++i) {
    const double side = cross(velocity, Vector{t.joint_x[i], t.joint_y[i]} - position);
    if (!(std::fabs(side) > margin)) return -1;
    if (side < 0.0) entry |= 1 << i;
  }
  return entry;
}

}  // namespace carom::lanes
