#include "events/flight/chain_tree.hpp"

#include <algorithm>

#include "carom/geometry/hull.hpp"

namespace carom::events {

using geometry::Box;
using geometry::Vector;

namespace {

double norm_1(Vector v) { return std::fabs(v.x) + std::fabs(v.y); }
double distance(Vector a, Vector b) { return std::sqrt(dot(a - b, a - b)); }
/// With roundings of centres and distances.
double enlarged(double radius, Vector centre) {
  return 1.0001 * radius + 4.0 * geometry::unit_roundoff * norm_1(centre);
}

}  // namespace

ChainTree::ChainTree(const std::vector<geometry::Curve>& pieces)
    : leaves_(std::bit_ceil(std::max<std::size_t>(pieces.size(), 2))), nodes_(2 * leaves_) {
  std::vector<Box> boxes(nodes_.size());
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const Box box = bounding_box(pieces[i]);
    boxes[leaves_ + i] = box;
    const Vector centre = 0.5 * (box.low + box.high);
    nodes_[leaves_ + i] = {centre, enlarged(0.5 * distance(box.low, box.high), centre)};
  }
  for (std::size_t k = leaves_; k-- > 1;) {
    const Disc &a = nodes_[2 * k], &b = nodes_[2 * k + 1];
    if (!(b.radius >= 0.0)) {
      nodes_[k] = a;
      boxes[k] = boxes[2 * k];
      continue;
    }
    boxes[k] = hull(boxes[2 * k], boxes[2 * k + 1]);
    const Vector centre = 0.5 * (boxes[k].low + boxes[k].high);
    nodes_[k] = {centre, enlarged(std::max(distance(centre, a.centre) + a.radius,
                                           distance(centre, b.centre) + b.radius),
                                  centre)};
  }
  for (const Disc& node : nodes_) reach_ = std::max(reach_, 1.01 * norm_1(node.centre));
}

}  // namespace carom::events
