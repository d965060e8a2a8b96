// Boxes: the smallest one around others, and whether two overlap.
#pragma once

#include <algorithm>
#include <iterator>
#include <vector>

#include "carom/geometry/curve.hpp"

namespace carom::geometry {

inline Box hull(const Box& a, const Box& b) {
  return {{std::min(a.low.x, b.low.x), std::min(a.low.y, b.low.y)},
          {std::max(a.high.x, b.high.x), std::max(a.high.y, b.high.y)}};
}
inline Box hull(const Box& box, Vector point) { return hull(box, Box{point, point}); }

/// The hull of the boxes of all elements of a list that is not empty; `box_of(element)` is a box.
Box hull_of(const auto& list, auto box_of) {
  Box whole = box_of(*std::begin(list));
  for (const auto& element : list) whole = hull(whole, box_of(element));
  return whole;
}
inline Box hull_of(const std::vector<Box>& boxes) {
  return hull_of(boxes, [](const Box& box) { return box; });
}

/// Edges count.
inline bool overlap(const Box& a, const Box& b) {
  return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y;
}

}  // namespace carom::geometry
