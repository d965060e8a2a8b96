// Many walls: the plane cut into cells, each with the pieces that may reach into it, and the cells that a
// flight may pass. docs/developer/many-walls.md derives the bounds.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "carom/geometry/exact_flight.hpp"
#include "carom/geometry/formulas.hpp"
#include "carom/geometry/prepared_curve.hpp"

namespace carom {

/// An axis cut into parts at increasing doubles. A number below the first cut is of the first part, one beyond
/// the last of the last. part() never falls as x grows: so a point that two boxes share is of a part that both
/// of them reach, however the cuts were rounded.
class CutAxis {
 public:
  CutAxis() = default;
  CutAxis(double low, double high, int parts);

  int parts() const { return static_cast<int>(cuts_.size()) - 1; }
  double low() const { return cuts_.front(); }
  double high() const { return cuts_.back(); }
  double cut(int i) const { return cuts_[static_cast<std::size_t>(i)]; }
  int part(double x) const {
    const int last = parts() - 1;
    // The guess may be wrong, the cuts tell.
    const double guess = std::fmin(std::fmax((x - cuts_.front()) * inverse_, 0.0), static_cast<double>(last));
    int i = static_cast<int>(guess);
    while (i > 0 && x < cut(i)) --i;
    while (i < last && x >= cut(i + 1)) ++i;
    return i;
  }

 private:
  std::vector<double> cuts_{0.0, 0.0};
  double inverse_ = 0.0;
};

/// A straight line, seen along the axis on which it advances most: b = b0 + (a - a0) slope, |slope| <= 1.
struct Course {
  bool upright = false;  ///< a is y
  double a0 = 0.0, b0 = 0.0, slope = 0.0;
  double speed = 0.0;    ///< da/dt
  double margin = 0.0;   ///< what the point's error costs

  /// From a point known to `delta` a coordinate.
  Course(geometry::Vector point, double delta, geometry::Vector direction) {
    upright = std::fabs(direction.y) > std::fabs(direction.x);
    a0 = upright ? point.y : point.x;
    b0 = upright ? point.x : point.y;
    speed = upright ? direction.y : direction.x;
    slope = (upright ? direction.x : direction.y) / speed;
    // b errs by delta, and by slope delta for the error of a; the part of the line that is looked at begins
    // up to delta before or after a0: 3 delta. The last digits: b0 itself is rounded in b and in its ends.
    margin = 3.1 * delta + 4.0 * geometry::unit_roundoff * std::fabs(b0);
  }
  struct Range {
    double low, high;
  };
  /// Contains every b of the line between two numbers of a.
  Range between(double from, double to) const {
    const double p = (from - a0) * slope, q = (to - a0) * slope;
    // p errs by 3u of itself, the sum by u of both, the ends by u of what they are.
    const double most = margin + 8.0 * geometry::unit_roundoff * std::fmax(std::fabs(p), std::fabs(q));
    return {b0 + std::fmin(p, q) - most, b0 + std::fmax(p, q) + most};
  }
};

class WallGrid {
 public:
  /// The pieces of a boundary within a box: outside of it nothing is looked for.
  WallGrid(const std::vector<geometry::Piece>& pieces, geometry::Vector first, geometry::Vector second,
           const geometry::Box& within);

  std::span<const int> pieces(int cell) const {
    const auto first = starts_[static_cast<std::size_t>(cell)], end = starts_[static_cast<std::size_t>(cell) + 1];
    return {list_.data() + first, end - first};
  }
  /// Where the list of a cell stands among those of all cells, one after the other.
  std::size_t first_entry(int cell) const { return starts_[static_cast<std::size_t>(cell)]; }
  int cells() const { return static_cast<int>(starts_.size()) - 1; }
  const std::vector<int>& entries() const { return list_; }
  /// The cell of a point.
  int cell_at(geometry::Vector x) const { return columns_.part(x.x) + columns_.parts() * rows_.part(x.y); }

  /// Follows a line from a point known to `delta` a coordinate. Calls visit(cell) for every cell that it may
  /// pass and then, from time to time, passed(kappa): of the line until then every cell has been visited.
  /// Stops where that is true.
  template <class Visit, class Passed>
  void along_line(geometry::Vector point, double delta, geometry::Vector velocity, const Visit& visit,
                  const Passed& passed) const {
    const Course line(point, delta, velocity);
    const CutAxis &along = line.upright ? rows_ : columns_, &across = line.upright ? columns_ : rows_;
    const int step_along = line.upright ? columns_.parts() : 1, step_across = line.upright ? 1 : columns_.parts();
    const bool forward = line.speed > 0.0;
    const double reach = 1.1 * delta + 2.0 * geometry::unit_roundoff * std::fabs(line.a0);
    if (forward ? line.a0 - reach > along.high() : line.a0 + reach < along.low()) {
      passed(-HUGE_VAL);
      return;
    }
    const int last = forward ? along.parts() - 1 : 0, step = forward ? 1 : -1;
    for (int i = along.part(forward ? line.a0 - reach : line.a0 + reach);; i += step) {
      const double end = along.cut(forward ? i + 1 : i), begin = along.cut(forward ? i : i + 1);
      const Course::Range b = line.between(forward ? std::fmax(begin, line.a0) : std::fmin(begin, line.a0), end);
      if (b.high >= across.low() && b.low <= across.high()) {
        const int top = across.part(b.high);
        for (int k = across.part(b.low); k <= top; ++k) visit(i * step_along + k * step_across);
      }
      if (i == last) break;
      // kappa = speed / way: two roundings; the way errs by delta and u.
      const double way = std::fabs(end - line.a0) - reach;
      if (way > 0.0 && passed(std::fabs(line.speed) / way * (1.0 + 8.0 * geometry::unit_roundoff))) return;
    }
    passed(-HUGE_VAL);
  }

  /// The same along a Larmor circle, once round. `speed`: |v| to rounding.
  template <class Visit, class Passed>
  void along_circle(geometry::Vector point, double delta, geometry::Vector velocity, double omega, double speed,
                    const Visit& visit, const Passed& passed) const {
    using geometry::Vector;
    const double w = std::fabs(omega), h = 0.5 * w;
    const double bend = 1.01 * w / (4.0 * speed);
    double before = HUGE_VAL, error = delta;
    Vector from = point;
    for (;;) {
      // On to the next kappa: past a chord as long as a cell, or as the way to the box, or past an eighth of
      // the circle. kappa = h cot(phase), and phases are added. Which numbers these are does not matter, as long
      // as kappa falls and less than half a turn lies between two.
      const double chord_length = std::fmax(width_, 0.5 * distance(from));
      const double sine = std::fmin(std::fmax(chord_length * w / (2.0 * speed), 0x1p-400), 0.38);
      const double turn = h * std::sqrt(1.0 - sine * sine) / sine;
      const double kappa = before < HUGE_VAL ? (before * turn - h * h) / (before + turn) : turn;
      const bool closing = before < 0.0 && !(before + turn > 0.0 && kappa < before);
      Vector to = point;
      double to_error = delta;
      if (!closing) {
        const Vector d = geometry::displacement(kappa, velocity, omega, 0.5);
        to = point + d;
        to_error = delta + 8.1 * geometry::unit_roundoff * (std::fabs(d.x) + std::fabs(d.y));
      }
      // An arc of at most half a circle of radius R stays within c^2 / 4R of its chord c, and within R. With the
      // ends' errors e, c^2 / 4R grows by at most 3.2 e: c < 0.8 R, and where e > R, R is below e.
      const Vector chord = to - from;
      const double most = 4.4 * std::fmax(error, to_error) + bend * dot(chord, chord);
      const auto spread = [&](double a, double b) {
        const double grown = most + 4.0 * geometry::unit_roundoff * std::fmax(std::fabs(a), std::fabs(b));
        if (!(grown < HUGE_VAL)) return Course::Range{-HUGE_VAL, HUGE_VAL};
        return Course::Range{std::fmin(a, b) - grown, std::fmax(a, b) + grown};
      };
      visit_box(spread(from.x, to.x), spread(from.y, to.y), visit);
      if (closing) break;
      if (passed(kappa)) return;
      before = kappa;
      from = to;
      error = to_error;
    }
    passed(-HUGE_VAL);
  }

 private:
  /// From a point to the box.
  double distance(geometry::Vector x) const {
    return std::fmax(std::fmax(std::fmax(columns_.low() - x.x, x.x - columns_.high()),
                               std::fmax(rows_.low() - x.y, x.y - rows_.high())),
                     0.0);
  }
  template <class Visit>
  void visit_box(Course::Range x, Course::Range y, const Visit& visit) const {
    if (!(x.high >= columns_.low() && x.low <= columns_.high() && y.high >= rows_.low() && y.low <= rows_.high()))
      return;
    const int left = columns_.part(x.low), right = columns_.part(x.high), top = rows_.part(y.high);
    for (int k = rows_.part(y.low); k <= top; ++k)
      for (int i = left; i <= right; ++i) visit(i + columns_.parts() * k);
  }
  struct Reach;
  template <class Visit>
  void cover(const Reach& reach, const Visit& visit) const;

  CutAxis columns_, rows_;
  double width_ = 0.0;  ///< of a cell, about
  std::vector<std::uint32_t> starts_;
  std::vector<int> list_;
};

}  // namespace carom
