// The shape of a barrier's gap along a path between two knots: what it says of crossings.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "events/step/barrier.hpp"
#include "events/step/step_path.hpp"

namespace carom::events {

/// A polynomial over a part of a step by its Bernstein coefficients: its values lie between the
/// smallest and the largest of them.
template <class Real, std::size_t size>
struct StepPolynomial {
  std::array<Real, size> coefficient;

  StepPolynomial<Real, size - 1> derivative() const {
    StepPolynomial<Real, size - 1> d;
    for (std::size_t k = 0; k + 1 < size; ++k)
      d.coefficient[k] = Real(static_cast<int>(size) - 1) * (coefficient[k + 1] - coefficient[k]);
    return d;
  }
  Real lowest() const {
    Real low = coefficient[0];
    for (const Real& c : coefficient) low = c < low ? c : low;
    return low;
  }
  Real highest() const {
    Real high = coefficient[0];
    for (const Real& c : coefficient) high = high < c ? c : high;
    return high;
  }
};

/// What a gap does between two knots. None: it keeps its sign, or only grows. Falling: it only
/// falls. Level: it changes by no more than its rounding. Missed: the path is off the piece.
enum class Shape { none, falling, convex, concave, level, unknown, missed };

/// Of the gap of a barrier along an arc of a path. Coefficients of it err by `noise` at most.
template <class Real>
class GapShape {
 public:
  /// `across`: the arc's error counts across the wall alone.
  GapShape(const Barrier<Real>& barrier, const PathArc<Real>& arc, const Real& noise, bool across)
      : b_(barrier), arc_(arc), noise_(noise), across_(across) {}

  Shape find() const {
    if (b_.graph) return misses() ? Shape::missed : of_graph();
    return b_.conic ? of_conic() : of_line();
  }

 private:
  struct Span {
    Real low, high;
  };

  // `error` is that of the gap; its derivatives err by what the coefficients of a polynomial that
  // small may differ by. Coefficients that differ by less than `noise` tell nothing, nor do those
  // within it of the wall.
  template <std::size_t size>
  Shape shape_of(const StepPolynomial<Real, size>& g, const Real& error) const {
    if (g.lowest() > error || g.highest() < -(error + noise_)) return Shape::none;
    const StepPolynomial<Real, size - 1> rate = g.derivative();
    const Real rate_error = Real(static_cast<int>(size) - 1) * (Real(2) * error + noise_);
    if (rate.lowest() > rate_error) return Shape::none;
    if (rate.highest() < -rate_error) return Shape::falling;
    const StepPolynomial<Real, size - 2> bend = rate.derivative();
    const Real bend_error = Real(2 * (static_cast<int>(size) - 2)) * rate_error;
    if (bend.lowest() > bend_error) return Shape::convex;
    if (bend.highest() < -bend_error) return Shape::concave;
    return g.highest() - g.lowest() > noise_ ? Shape::unknown : Shape::level;
  }

  Shape of_line() const {
    StepPolynomial<Real, 6> g;
    for (std::size_t k = 0; k < 6; ++k) g.coefficient[k] = b_.gap(arc_.points[k]);
    return shape_of(g, across_ ? arc_.error_along(b_.first) : arc_.error);
  }

  Shape of_conic() const {
    using Vector = geometry::BasicVector<Real>;
    const auto seen = [&](const Vector& e) { return Vector{dot(b_.first, e), dot(b_.second, e)}; };
    std::array<Vector, 6> y, d{};  // the quintic's points, and what they differ by from the cubic's
    Real size(0);
    for (std::size_t k = 0; k < 6; ++k) {
      y[k] = seen(arc_.points[k] - b_.origin);
      const Real n = PathHull<Real>::norm(y[k]);
      size = size < n ? n : size;
    }
    for (std::size_t k = 0; k < 2; ++k) d[2 + k] = seen(arc_.difference[k]);
    static constexpr std::array<int, 6> five = {1, 5, 10, 10, 5, 1};
    static constexpr std::array<int, 11> ten = {1, 10, 45, 120, 210, 252, 210, 120, 45, 10, 1};
    StepPolynomial<Real, 11> g, differs;
    for (std::size_t m = 0; m <= 10; ++m) {
      Real sum(0), change(0);
      for (std::size_t k = m > 5 ? m - 5 : 0; k <= 5 && k <= m; ++k) {
        const Real weight(five[k] * five[m - k]);
        sum = sum + weight * dot(y[k], y[m - k]);
        change = change + weight * dot(d[k], Real(2) * y[m - k] - d[m - k]);
      }
      g.coefficient[m] = b_.orientation * (Real(1) - sum / Real(ten[m])) / Real(2);
      differs.coefficient[m] = change / Real(2 * ten[m]);
    }
    if (across_) return shape_of(g, std::max(differs.highest(), -differs.lowest()));
    const Real stretch = PathHull<Real>::norm(b_.first) + PathHull<Real>::norm(b_.second);
    const Real error = stretch * arc_.error;  // of y
    return shape_of(g, size * error + error * error);
  }

  // Does the arc stay outside the rectangle in the frame of its chord that holds a graph's part?
  // Parts of long arcs beside short walls: so most walls that the whole step comes near to cost no
  // knot.
  bool misses() const {
    std::array<geometry::BasicVector<Real>, 6> p;
    for (std::size_t k = 0; k < 6; ++k) {
      const auto e = arc_.points[k] - b_.origin;
      p[k] = {dot(b_.second, e), dot(b_.first, e)};
    }
    return misses(p, arc_.error + b_.slack, 0);
  }
  bool misses(std::array<geometry::BasicVector<Real>, 6> p, const Real& margin, int depth) const {
    constexpr int most_halvings = 8;
    StepPolynomial<Real, 6> s, y;
    for (std::size_t k = 0; k < 6; ++k) {
      s.coefficient[k] = p[k].x;
      y.coefficient[k] = p[k].y;
    }
    if (s.highest() < -margin || s.lowest() > b_.graph->length() + margin ||
        y.highest() < b_.lowest - margin || y.lowest() > b_.highest + margin)
      return true;
    if (depth == most_halvings || !(s.highest() - s.lowest() > b_.graph->length())) return false;
    std::array<geometry::BasicVector<Real>, 6> first;
    for (std::size_t last = 6; last > 0; --last) {
      first[6 - last] = p[0];
      for (std::size_t k = 0; k + 1 < last; ++k) p[k] = (Real(1) / Real(2)) * (p[k] + p[k + 1]);
    }
    return misses(first, margin, depth + 1) && misses(p, margin, depth + 1);
  }

  // Of a graph, seen from the middle of the arc's places s: there h = h_m + h'_m (s - m), whose gap
  // is a polynomial of the arc's degree, and a rest r with |r'| <= |h''| |s - m|. So the gap is
  // that polynomial less r, its rate that less (h' - h'_m) s', and its bend that less (h' - h'_m)
  // s'' and h'' s'^2.
  Shape of_graph() const {
    const CurveGraph<Real>& graph = *b_.graph;
    StepPolynomial<Real, 6> g, s;
    for (std::size_t k = 0; k < 6; ++k) {
      const auto e = arc_.points[k] - b_.origin;
      s.coefficient[k] = dot(b_.second, e);
      g.coefficient[k] = dot(b_.first, e);
    }
    const Real low = s.lowest() - arc_.error, high = s.highest() + arc_.error;
    const Real middle = low + (high - low) / Real(2), way = (high - low) / Real(2);
    const auto [height, slope, bend] = graph.at(middle);
    for (std::size_t k = 0; k < 6; ++k)
      g.coefficient[k] = g.coefficient[k] - height - slope * (s.coefficient[k] - middle);
    // h'' about there: within the part it changes by no more than `turn` times the way.
    const auto size = [](const Real& a) { return a < Real(0) ? -a : a; };
    Span bends{-graph.bend, graph.bend};
    if (low > Real(0) && high < graph.length())
      bends = {std::max(bends.low, bend - graph.turn * way),
               std::min(bends.high, bend + graph.turn * way)};
    const Real largest = std::max(size(bends.low), size(bends.high));
    const Real half = way * way / Real(2);
    const Span rest{std::min(bends.low, Real(0)) * half, std::max(bends.high, Real(0)) * half};

    const auto across = b_.first - slope * b_.second;
    const Real error = across_ ? arc_.error_along(across) + largest * way * arc_.error
                               : (Real(1) + graph.slope) * arc_.error;
    if (g.lowest() - rest.high > error || g.highest() - rest.low < -(error + noise_))
      return Shape::none;
    const auto speeds = s.derivative();
    const auto largest_of = [&](const auto& p) {
      return std::max(size(p.lowest()), size(p.highest()));
    };
    const Real turned = largest * way;  // bounds |h' - h'_m|
    const StepPolynomial<Real, 5> rate = g.derivative();
    const Real speed_error = Real(10) * arc_.error;
    const Real rate_error =
        Real(5) * (Real(2) * error + noise_) + turned * (largest_of(speeds) + speed_error);
    if (rate.lowest() > rate_error) return Shape::none;
    if (rate.highest() < -rate_error) return Shape::falling;
    const auto accelerations = speeds.derivative();
    const Real slowest = speeds.lowest() - speed_error, fastest = speeds.highest() + speed_error;
    const Real most = std::max(slowest * slowest, fastest * fastest);
    const Real least = slowest > Real(0) || fastest < Real(0)
                           ? std::min(slowest * slowest, fastest * fastest)
                           : Real(0);
    const Span turns{bends.low * (bends.low < Real(0) ? most : least),
                     bends.high * (bends.high > Real(0) ? most : least)};
    const StepPolynomial<Real, 4> curved = rate.derivative();
    const Real bend_error = Real(8) * Real(5) * (Real(2) * error + noise_) +
                            turned * (largest_of(accelerations) + Real(8) * speed_error);
    if (curved.lowest() - turns.high > bend_error) return Shape::convex;
    if (curved.highest() - turns.low < -bend_error) return Shape::concave;
    return g.highest() - g.lowest() + rest.high - rest.low > noise_ ? Shape::unknown : Shape::level;
  }

  const Barrier<Real>& b_;
  const PathArc<Real>& arc_;
  const Real noise_;
  bool across_;
};

}  // namespace carom::events
