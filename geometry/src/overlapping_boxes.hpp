// All pairs of boxes that overlap, by a sweep along the direction in which they spread most.
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

#include "carom/geometry/hull.hpp"

namespace carom::geometry {

/// Calls report(i, j) once for each pair; stops when it answers false.
void overlapping_boxes(const std::vector<Box>& boxes, const auto& report) {
  if (boxes.empty()) return;
  const Box whole = hull_of(boxes);
  const bool along_x = whole.high.x - whole.low.x >= whole.high.y - whole.low.y;
  const auto low = [&](std::size_t i) { return along_x ? boxes[i].low.x : boxes[i].low.y; };
  const auto high = [&](std::size_t i) { return along_x ? boxes[i].high.x : boxes[i].high.y; };
  const auto beside = [&](std::size_t i, std::size_t j) {
    return along_x ? boxes[i].low.y <= boxes[j].high.y && boxes[j].low.y <= boxes[i].high.y
                   : boxes[i].low.x <= boxes[j].high.x && boxes[j].low.x <= boxes[i].high.x;
  };
  std::vector<std::size_t> order(boxes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
    return low(i) < low(j) || (low(i) == low(j) && i < j);
  });
  for (std::size_t m = 0; m < order.size(); ++m)
    for (std::size_t n = m + 1; n < order.size() && low(order[n]) <= high(order[m]); ++n)
      if (beside(order[m], order[n]) && !report(order[m], order[n])) return;
}

}  // namespace carom::geometry
