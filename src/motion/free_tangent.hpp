// Two deviations across the orbit of a free particle, carried from hit to hit.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "carom/geometry/curve_frame.hpp"
#include "carom/geometry/lattice.hpp"
#include "carom/motion/state.hpp"
#include "carom/motion/transverse.hpp"
#include "motion/long_deviation.hpp"

namespace carom::motion {

WallForm<double> wall_form(const geometry::Curve&);
/// What a hit needs of a table.
struct TangentWalls {
  std::vector<WallForm<double>> walls;
  /// A wall: its Bézier curve, or null; empty where there is none.
  std::vector<std::shared_ptr<const geometry::BezierForm>> beziers;
  std::optional<geometry::Lattice> lattice;
};
/// `walls`: things with a `curve`.
template <class Walls>
TangentWalls tangent_walls(const Walls& walls, const std::optional<geometry::Lattice>& lattice) {
  TangentWalls made;
  for (const auto& wall : walls) {
    if (std::holds_alternative<geometry::Bezier>(wall.curve)) {
      made.beziers.resize(walls.size());
      made.beziers[made.walls.size()] = geometry::frame_of(wall.curve).bezier;
      made.walls.emplace_back();
      continue;
    }
    made.walls.push_back(wall_form(wall.curve));
  }
  made.lattice = lattice;
  return made;
}

/// Of one particle. Lengths are sqrt(place^2 + (unit rate)^2) with a unit of time; at the start
/// both are 1 and at a right angle, so that the area between them is 1 for ever.
struct FreeTangent {
  Transverse deviation[2];
  double shrunk[2] = {};  ///< how often long_deviation was taken out
  State last;             ///< after the last hit
  double omega = 0.0, square = 1.0, unit = 1.0;

  void begin(const State&, const Particle&, double unit_length);
  /// The particle has hit a wall, and leaves it in this state.
  void hit(const TangentWalls&, const State&);
  /// Logarithms of the lengths at a time that is not before the last hit.
  std::array<double, 2> logarithms(double time) const;
};

}  // namespace carom::motion
