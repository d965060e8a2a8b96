// The potential energy of all particles as a function of their sites, with first and second
// derivatives.
#pragma once

#include <vector>

#include "carom/forces/force_field.hpp"
#include "carom/geometry/curve_frame.hpp"
#include "carom/system/system.hpp"

namespace carom::analyses {

/// Where a particle is. On a wall it can move along it alone: one degree of freedom in place of
/// two; at a corner that it is pressed into, none.
struct Site {
  geometry::Vector position;
  int wall = -1;
  double u = 0.0;
  bool corner = false;  ///< the start of `wall`
  int end = 0;          ///< -1: before the start of its wall, 1: beyond its end, straight on
  int freedom() const { return corner ? 0 : wall >= 0 ? 1 : 2; }
};
using Sites = std::vector<Site>;
std::size_t freedom(const Sites&);

/// A square matrix, row by row.
struct Matrix {
  explicit Matrix(std::size_t rows) : n(rows), a(rows * rows, 0.0) {}
  double& operator()(std::size_t i, std::size_t j) { return a[i * n + j]; }
  double operator()(std::size_t i, std::size_t j) const { return a[i * n + j]; }
  std::size_t n;
  std::vector<double> a;
};

/// What the energy does near a configuration.
struct Shape {
  std::vector<double> slope;  ///< one a degree of freedom
  Matrix curvature{0};
  /// Bounds of what rounding adds to a slope, and to an eigenvalue of the curvature.
  double slope_error = 0.0, curvature_error = 0.0;
};

class Landscape {
 public:
  explicit Landscape(const System&);

  /// NaN or infinity where the potential has no value.
  double energy(const Sites&) const;
  /// The bound of its rounding: the sizes of its terms, each within some roundings.
  double energy_error(const Sites&) const;
  std::vector<geometry::Vector> forces(const Sites&) const;
  /// The slope of the energy in each degree of freedom.
  std::vector<double> slope(const Sites&) const;
  Shape shape(const Sites&) const;
  /// Second derivatives' counterpart of the magnetic force: m q'' = -K q + G q'.
  Matrix gyroscopic(const Sites&) const;
  /// The mass that moves in each degree of freedom.
  std::vector<double> masses(const Sites&) const;
  bool in_field() const;

  /// By so much in each degree of freedom: x and y, or along the wall. Beyond the end of its wall a
  /// place goes straight on, so that the energy stays smooth.
  Sites displaced(const Sites&, const double* by) const;
  geometry::Vector tangent(const Site&) const;
  geometry::Vector normal(const Site&) const;  ///< into the table

  /// Of walls whose ends meet.
  int next(int wall) const { return system_.table->wall(wall).next; }
  int previous(int wall) const { return system_.table->wall(wall).previous; }

  const System& system() const { return system_; }
  const std::vector<geometry::CurveFrame>& frames() const { return frames_; }

 private:
  geometry::Vector in_cell(geometry::Vector) const;
  geometry::Vector separation(geometry::Vector) const;
  const geometry::CurveFrame& frame(const Site& p) const {
    return frames_[static_cast<std::size_t>(p.wall)];
  }

  const System& system_;
  const ForceField& field_;
  const geometry::Lattice* lattice_;
  std::vector<geometry::CurveFrame> frames_;
};

}  // namespace carom::analyses
