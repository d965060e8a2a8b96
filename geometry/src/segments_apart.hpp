// A quick look before exact contacts: most pairs of segments whose boxes overlap are far from each
// other.
#pragma once

#include <cmath>
#include <variant>

#include "carom/geometry/curve.hpp"

namespace carom::geometry {

/// Is it certain that both points lie on one side of the line through a segment, and off it?
inline bool on_one_side(const Segment& line, Vector p, Vector q) {
  int side = 0;
  for (const Vector x : {p, q}) {
    const double l = (line.to.x - line.from.x) * (x.y - line.from.y),
                 r = (line.to.y - line.from.y) * (x.x - line.from.x);
    // Two differences and a product on either side, 3u each, and their difference: u of at most the
    // same.
    if (!(std::fabs(l - r) > 4.1 * 0x1p-53 * (std::fabs(l) + std::fabs(r)) + 0x1p-1000))
      return false;
    const int here = l > r ? 1 : -1;
    if (side != 0 && here != side) return false;
    side = here;
  }
  return true;
}

/// Both curves are segments, and certainly have no point in common.
inline bool segments_apart(const Curve& a, const Curve& b) {
  const auto *s = std::get_if<Segment>(&a), *t = std::get_if<Segment>(&b);
  return s != nullptr && t != nullptr &&
         (on_one_side(*s, t->from, t->to) || on_one_side(*t, s->from, s->to));
}

}  // namespace carom::geometry
