// A closed loop of exact pieces: point location and orientation by counting crossings of a ray.
#pragma once

#include <vector>

#include "carom/geometry/region.hpp"
#include "exact_piece.hpp"

namespace carom::geometry {

class ExactLoop {
 public:
  ExactLoop(const Loop& loop, const DyadicVector& shift);

  std::size_t size() const { return pieces_.size(); }
  const ExactPiece& piece(std::size_t i) const { return pieces_[i]; }
  const Box& box(std::size_t i) const { return boxes_[i]; }
  const Box& box() const { return whole_; }
  std::size_t next(std::size_t i) const { return i + 1 == size() ? 0 : i + 1; }
  std::size_t previous(std::size_t i) const { return i == 0 ? size() - 1 : i - 1; }

  bool on_boundary(const ExactPoint& point) const;
  /// For a point that is not on the loop.
  bool inside(const ExactPoint& point) const;
  bool counterclockwise() const;

 private:
  /// Crossings with the ray from `origin` along `d`; `own`: the piece that the origin lies on (its
  /// size if none). -1: the ray meets a joint or is tangent, take another.
  int crossings(const ExactPoint& origin, const DyadicVector& d, std::size_t own) const;

  std::vector<ExactPiece> pieces_;
  std::vector<Box> boxes_;
  Box whole_;
};

/// Points of a curve that ends at the parameter `end`: its start for n = 0, others for n = 1, 2, …
ExactPoint sample_point(const ExactCurve& curve, double end, int n);

double sample_parameter(double end, int n);  ///< the same for n > 0, as a parameter

/// Displaced by a rounded vector and enlarged by that rounding.
Box moved(const Box& box, Vector by);

}  // namespace carom::geometry
