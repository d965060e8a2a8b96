#include "events/flight/chain_tree.hpp"

#include <algorithm>
#include <bit>

namespace carom::events {

using geometry::Vector;

namespace {

double norm_1(Vector v) { return std::fabs(v.x) + std::fabs(v.y); }

/// Of a point from the segment between two others.
double distance(Vector point, Vector from, Vector to) {
  const Vector way = to - from, d = point - from;
  const double square = dot(way, way);
  const double share = square > 0.0 ? std::clamp(dot(d, way) / square, 0.0, 1.0) : 0.0;
  const Vector off = d - share * way;
  return std::sqrt(dot(off, off));
}
/// With the rounding of distances.
double enlarged(double bulge, Vector near) {
  return 1.0001 * bulge + 16.0 * geometry::unit_roundoff * norm_1(near);
}

/// How far a curve is from its chord at most.
double bulge_of(const geometry::Curve& curve) {
  const Vector from = start_point(curve), to = end_point(curve);
  double bulge = 0.0;
  if (const auto* bezier = std::get_if<geometry::Bezier>(&curve)) {
    for (int i = 1; i < bezier->degree; ++i)
      bulge = std::max(bulge, distance(bezier->control(i), from, to));
  } else if (!std::holds_alternative<geometry::Segment>(curve)) {
    const geometry::Box box = bounding_box(curve);
    for (const Vector corner :
         {box.low, box.high, Vector{box.low.x, box.high.y}, Vector{box.high.x, box.low.y}})
      bulge = std::max(bulge, distance(corner, from, to));
  }
  return bulge;
}

}  // namespace

ChainTree::ChainTree(const std::vector<geometry::Curve>& pieces) {
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const Vector from = start_point(pieces[i]);
    if (joints_.empty()) joints_.push_back(from);
    if (!(joints_.back() == from)) {  // over to the next loop
      joints_.push_back(from);
      pieces_.emplace_back();
    }
    joints_.push_back(end_point(pieces[i]));
    pieces_.push_back({{bulge_of(pieces[i]), 0.0}, static_cast<int>(i)});
  }
  leaves_ = std::bit_ceil((pieces_.size() + in_leaf - 1) / in_leaf);
  roots_ = std::min(leaves_, most_roots);
  pieces_.resize(leaves_ * in_leaf);
  joints_.resize(pieces_.size() + 1, joints_.back());
  const auto bounds = [this](std::size_t first, std::size_t count, double bulge) {
    const Vector from = joints_[first], way = joints_[first + count] - from;
    return Bounds{enlarged(bulge, from), 0.2501 * dot(way, way)};
  };
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const int number = pieces_[i].number;
    pieces_[i] = {bounds(i, 1, pieces_[i].bulge), number};
  }
  // Parts of a chain are within their bulges of chords, whose ends are farther from the chain's own
  // chord than all else of them.
  nodes_.resize(2 * leaves_);
  for (std::size_t k = 2 * leaves_; k-- > 1;) {
    const std::size_t level = std::bit_floor(k), count = pieces_.size() / level,
                      first = (k - level) * count;
    const Vector from = joints_[first], to = joints_[first + count];
    double bulge = 0.0, away = 0.0;
    if (k < leaves_) {
      bulge = std::max(nodes_[2 * k].bulge, nodes_[2 * k + 1].bulge);
      away = distance(joints_[first + count / 2], from, to);
    } else {
      for (std::size_t i = first; i < first + count; ++i) {
        bulge = std::max(bulge, pieces_[i].bulge);
        away = std::max(away, distance(joints_[i], from, to));
      }
    }
    nodes_[k] = {bounds(first, count, away + bulge), joints_[first + count / 2]};
  }
  for (const Vector& joint : joints_) reach_ = std::max(reach_, 1.01 * norm_1(joint));
}

}  // namespace carom::events
