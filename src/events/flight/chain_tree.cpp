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

ChainTree::Cone ChainTree::cone_around(const std::vector<Vector>& directions) {
  Vector middle;
  for (const Vector& d : directions)
    if (const double size = std::sqrt(dot(d, d)); size > 0.0) middle = middle + (1.0 / size) * d;
  const double size = std::sqrt(dot(middle, middle));
  if (!(size > 0.0)) return {};
  middle = (1.0 / size) * middle;
  // Tangents of their angles to the middle.
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (const Vector& d : directions) {
    if (d == Vector{}) continue;
    const double ahead = dot(middle, d), aside = cross(middle, d);
    if (!(ahead > 0x1p-20 * (std::fabs(aside)))) return {};
    least = std::min(least, aside / ahead);
    most = std::max(most, aside / ahead);
  }
  const auto turned = [&](double slope) {
    const Vector d = middle + slope * geometry::left(middle);
    return (1.0 / std::sqrt(dot(d, d))) * d;
  };
  constexpr double margin = 0x1p-30;  // an angle
  return {turned(least - margin * (1.0 + least * least)),
          turned(most + margin * (1.0 + most * most))};
}

/// The tangents of a Bezier curve lie between those of its control polygon. Arcs are left to their
/// bulges.
ChainTree::Cone ChainTree::cone_of(const geometry::Curve& curve) {
  std::vector<Vector> directions;
  if (const auto* bezier = std::get_if<geometry::Bezier>(&curve)) {
    for (int i = 0; i < bezier->degree; ++i)
      directions.push_back(bezier->control(i + 1) - bezier->control(i));
  } else if (std::holds_alternative<geometry::Segment>(curve)) {
    directions.push_back(end_point(curve) - start_point(curve));
  }
  return cone_around(directions);
}

ChainTree::ChainTree(const std::vector<geometry::Curve>& pieces) {
  std::vector<Cone> cones;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const Vector from = start_point(pieces[i]);
    if (joints_.empty()) joints_.push_back(from);
    if (!(joints_.back() == from)) {  // over to the next loop
      joints_.push_back(from);
      pieces_.emplace_back();
      cones.emplace_back();
    }
    joints_.push_back(end_point(pieces[i]));
    pieces_.push_back({{bulge_of(pieces[i]), 0.0}, static_cast<int>(i)});
    cones.push_back(cone_of(pieces[i]));
  }
  leaves_ = std::bit_floor(std::max(pieces_.size() / least_in_leaf, std::size_t{1}));
  in_leaf_ = (pieces_.size() + leaves_ - 1) / leaves_;
  roots_ = std::min(leaves_, Roots::most);
  const std::size_t in_use = pieces_.size();
  pieces_.resize(leaves_ * in_leaf_);
  joints_.resize(pieces_.size() + 1, joints_.back());
  const auto bounds = [this](std::size_t first, std::size_t count, double bulge) {
    const Vector from = joints_[first], way = joints_[first + count] - from;
    return Bounds{enlarged(bulge, from), 0.2501 * dot(way, way)};
  };
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const int number = pieces_[i].number;
    pieces_[i] = {bounds(i, 1, pieces_[i].bulge), number};
  }
  // Without tangents: those of no piece; all pieces behind the last one are such.
  const auto tangents_of = [&](std::size_t k, std::size_t first, std::size_t count) {
    std::vector<Vector> directions;
    const auto add = [&](const Cone& cone) {
      directions.push_back(cone.first);
      directions.push_back(cone.last);
      return !(cone.first == Vector{});
    };
    if (k >= leaves_) {
      for (std::size_t i = first; i < std::min(first + count, in_use); ++i)
        if (!add(cones[i])) return Cone{};
    } else {
      for (const std::size_t half : {2 * k, 2 * k + 1}) {
        const std::size_t begin = first + (half - 2 * k) * (count / 2);
        if (begin < in_use && !add(nodes_[half].tangents)) return Cone{};
      }
    }
    return cone_around(directions);
  };
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
    nodes_[k] = {bounds(first, count, away + bulge), tangents_of(k, first, count),
                 joints_[first + count / 2]};
  }
  root_step_ = pieces_.size() / roots_;
  for (std::size_t k = 0; k < roots_; ++k) {
    const Node& root = nodes_[roots_ + k];
    first_.first_x[k] = root.tangents.first.x;
    first_.first_y[k] = root.tangents.first.y;
    first_.last_x[k] = root.tangents.last.x;
    first_.last_y[k] = root.tangents.last.y;
    first_.bulge[k] = root.bulge;
    first_.quarter[k] = root.quarter;
  }
  for (std::size_t k = 0; k <= roots_; ++k) {
    first_.x[k] = joints_[k * root_step_].x;
    first_.y[k] = joints_[k * root_step_].y;
  }
  for (const Vector& joint : joints_) reach_ = std::max(reach_, 1.01 * norm_1(joint));
}

}  // namespace carom::events
