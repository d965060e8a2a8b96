// Long chains of walls: a binary tree over pieces that follow each other, in which a flight finds
// those that it may meet. docs/developer/many-walls.md.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "carom/geometry/curve.hpp"
#include "carom/geometry/filter.hpp"

namespace carom::events {

class ChainTree {
 public:
  explicit ChainTree(const std::vector<geometry::Curve>& pieces);

  /// Calls visit(piece), ascending, for all but pieces that a flight surely misses.
  template <class Visit>
  void along_line(geometry::Vector start, geometry::Vector velocity,
                  const geometry::FlightScale& scale, const Visit& visit) const {
    const double error = error_of(start, scale), speed = 1.0001 * length(velocity);
    look(
        [=](const geometry::Vector& joint) {
          const geometry::Vector d = joint - start;
          return Seen{cross(velocity, d), dot(velocity, d)};
        },
        [=](const Bounds& node, const Seen& from, const Seen& to) {
          const double near = speed * node.bulge + error;
          return beside(from, to, near) || std::max(from.ahead, to.ahead) < -near;
        },
        visit);
  }
  template <class Visit>
  void along_circle(geometry::Vector start, geometry::Vector velocity, double omega,
                    const geometry::FlightScale& scale, const Visit& visit) const {
    const double error = error_of(start, scale);
    const double speed = 2.0002 * length(velocity), w = 1.0001 * scale.omega;
    look(
        [=](const geometry::Vector& joint) {
          return Seen{geometry::side_of_flight(velocity, joint - start, omega), 0.0};
        },
        [=](const Bounds& node, const Seen& from, const Seen& to) {
          return beside(from, to, node.bulge * (speed + w * node.bulge) + w * node.quarter + error);
        },
        visit);
  }

 private:
  /// Pieces that follow each other lie within `bulge` of the chord from their start to their end;
  /// `quarter` of its square.
  struct Bounds {
    double bulge = 0.0, quarter = 0.0;
  };
  struct Node : Bounds {
    geometry::Vector middle;  ///< the joint of its halves
  };
  struct Piece : Bounds {
    int number = -1;  ///< -1: none, or the way from one loop to the next
  };
  /// A joint as a flight sees it.
  struct Seen {
    double side, ahead;
  };
  /// Are both on one side, farther off than `near`?
  static bool beside(const Seen& from, const Seen& to, double near) {
    return std::min(from.side, to.side) > near || std::max(from.side, to.side) < -near;
  }
  static double length(geometry::Vector v) { return std::sqrt(dot(v, v)); }
  /// Of the side of a joint.
  double error_of(geometry::Vector start, const geometry::FlightScale& scale) const {
    return side_error(scale, reach_ + std::fabs(start.x) + std::fabs(start.y));
  }

  /// `missed(node, from, to)`: a flight that sees the ends of a node so surely misses it.
  template <class See, class Missed, class Visit>
  void look(const See see, const Missed missed, const Visit& visit) const {
    struct Open {
      std::size_t node;
      Seen from, to;
    };
    std::array<Open, 64> open;
    std::size_t left = 0;
    const Node* const nodes = nodes_.data();
    const std::size_t leaves = leaves_;
    // From the last of the roots to the first, so that the first comes first.
    const std::size_t step = pieces_.size() / roots_;
    Seen to = see(joints_[pieces_.size()]);
    for (std::size_t k = roots_; k-- > 0;) {
      const Seen from = see(joints_[k * step]);
      if (!missed(nodes[roots_ + k], from, to)) open[left++] = {roots_ + k, from, to};
      to = from;
    }
    while (left > 0) {
      auto [k, from, end] = open[--left];
      // Down to the leaf, past halves that are surely missed.
      while (k < leaves) {
        const Seen middle = see(nodes[k].middle);
        k *= 2;
        const bool second = !missed(nodes[k + 1], middle, end);
        if (!missed(nodes[k], from, middle)) {
          if (second) open[left++] = {k + 1, middle, end};
          end = middle;
        } else if (second) {
          ++k;
          from = middle;
        } else {
          break;
        }
      }
      if (k < leaves) continue;
      const std::size_t first = (k - leaves) * in_leaf;
      for (std::size_t i = first; i < first + in_leaf; ++i) {
        const Seen after = see(joints_[i + 1]);
        if (!missed(pieces_[i], from, after) && pieces_[i].number >= 0) visit(pieces_[i].number);
        from = after;
      }
    }
  }

  static constexpr std::size_t in_leaf = 4, most_roots = 8;
  std::size_t leaves_ = 1, roots_ = 1;
  /// Numbered by levels: the children of k are 2k and 2k + 1, the leaves come last. Flights begin
  /// with those of a level whose number is roots_.
  std::vector<Node> nodes_;
  std::vector<Piece> pieces_;             ///< those of leaf k from in_leaf k on
  std::vector<geometry::Vector> joints_;  ///< before, between and behind them
  double reach_ = 0.0;                    ///< bounds the l1 norm of all joints
};

}  // namespace carom::events
