// Long chains of walls: a binary tree of discs about pieces that follow each other, in which a
// flight finds those that it may meet. docs/developer/many-walls.md.
#pragma once

#include <bit>
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
    const double far = reach_ + std::fabs(start.x) + std::fabs(start.y);
    // Each coordinate of a disc's centre seen from the start errs by delta and u, products and
    // their sum by 2u; 1.0001: roundings of speeds and radii.
    const double error =
        scale.inflation * scale.speed_1 * (scale.delta + 4.1 * geometry::unit_roundoff * far);
    const double speed = 1.0001 * std::sqrt(dot(velocity, velocity));
    look(
        [&](const Disc& disc) {
          const geometry::Vector d = disc.centre - start;
          const double near = speed * disc.radius + error;
          return std::fabs(cross(velocity, d)) <= near && dot(velocity, d) >= -near;
        },
        visit);
  }
  /// With R the radius of the Larmor circle and D the distance of its centre from the disc's, it
  /// meets the disc only where |D^2 - R^2| <= 2 R r + r^2; omega (D^2 - R^2) is the side of the
  /// disc's centre.
  template <class Visit>
  void along_circle(geometry::Vector start, geometry::Vector velocity, double omega,
                    const geometry::FlightScale& scale, const Visit& visit) const {
    const double far = reach_ + std::fabs(start.x) + std::fabs(start.y);
    const double error = side_error(scale, far);
    const double speed = 2.0002 * std::sqrt(dot(velocity, velocity)), w = 1.0001 * scale.omega;
    look(
        [&](const Disc& disc) {
          const geometry::Vector d = disc.centre - start;
          return std::fabs(geometry::side_of_flight(velocity, d, omega)) <=
                 disc.radius * (speed + w * disc.radius) + error;
        },
        visit);
  }

 private:
  struct Disc {
    geometry::Vector centre;
    double radius = NAN;  ///< not a number, near nothing: without pieces
  };
  /// Nodes are numbered by levels: the children of k are 2k and 2k + 1, the leaves come last.
  template <class Near, class Visit>
  void look(const Near& near, const Visit& visit) const {
    const auto past = [](std::size_t node) { return (node + 1) >> std::countr_zero(node + 1); };
    std::size_t node = 1;
    do {
      if (!near(nodes_[node])) {
        node = past(node);
      } else if (node < leaves_) {
        node *= 2;
      } else {
        visit(static_cast<int>(node - leaves_));
        node = past(node);
      }
    } while (node != 1);
  }

  std::size_t leaves_ = 1;
  std::vector<Disc> nodes_;
  double reach_ = 0.0;  ///< bounds the l1 norm of all centres
};

}  // namespace carom::events
