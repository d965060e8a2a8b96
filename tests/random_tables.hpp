// Random tables and flights for tests of decisions.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <variant>
#include <vector>

#include "soak.hpp"
#include "tables_by_hand.hpp"

namespace carom::tests {

/// Random numbers of the tests.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : random_(seed) {}
  double unit() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
  double between(double a, double b) { return a + (b - a) * unit(); }
  /// Uniform in the logarithm.
  double spread(double a, double b) { return std::exp(between(std::log(a), std::log(b))); }
  int whole(int low, int high) {
    return low + static_cast<int>(random_() % static_cast<std::uint64_t>(high - low + 1));
  }
  bool coin() { return whole(0, 1) == 0; }
  double sign() { return coin() ? 1.0 : -1.0; }
  Vector direction() {
    const double angle = between(0.0, 6.283185307179586);
    return {std::cos(angle), std::sin(angle)};
  }

 private:
  std::mt19937_64 random_;
};

enum class Shape {
  polygon,
  arcs,
  stadium,
  mushroom,
  discs,
  annulus,
  ellipse,
  elliptic_arcs,
  count
};

/// A valid table of that shape, of that size, about `at`.
/// `flattest`: largest distance of an arc's centre from its chord, in chords.
inline Table random_table(Shape shape, double size, Vector at, Dice& dice, double flattest = 30.0) {
  const auto corners = [&](int n) {
    std::vector<Vector> points;
    const double first = dice.between(0.0, 6.28);
    for (int i = 0; i < n; ++i) {
      const double angle = first + 6.283185307179586 / n * (i + dice.between(-0.12, 0.12));
      const double r = size * dice.between(0.85, 1.0);
      points.push_back({at.x + r * std::cos(angle), at.y + r * std::sin(angle)});
    }
    return points;
  };
  switch (shape) {
    case Shape::polygon: {
      // A star about its centre, with reflex corners.
      std::vector<Vector> points;
      const int n = dice.whole(3, 9);
      for (int i = 0; i < n; ++i) {
        const double angle = 6.283185307179586 / n * (i + dice.between(-0.3, 0.3));
        const double r = size * dice.between(0.3, 1.0);
        points.push_back({at.x + r * std::cos(angle), at.y + r * std::sin(angle)});
      }
      return polygon(points);
    }
    case Shape::arcs:
    case Shape::elliptic_arcs: {
      const std::vector<Vector> points = corners(dice.whole(3, 6));
      std::vector<Curve> sides;
      for (std::size_t i = 0; i < points.size(); ++i) {
        const Vector from = points[i], to = points[(i + 1) % points.size()];
        // Shallow arcs, bulging outwards (about a centre on the left) or inwards.
        const bool outwards = dice.coin();
        const double offset = (outwards ? 1.0 : -1.0) * dice.spread(outwards ? 0.9 : 2.0, flattest);
        const int kind = dice.whole(0, 2);
        if (kind == 0)
          sides.push_back(Segment{from, to});
        else if (kind == 1 && shape == Shape::elliptic_arcs) {
          // An axis along the chord: with it the ellipse is a circle, pressed by the ratio.
          const double ratio = dice.between(0.7, 1.0);
          const Vector chord = to - from, axis = (1.0 / std::sqrt(dot(chord, chord))) * chord;
          sides.push_back(EllipticArc{from, to, axis, ratio, offset / ratio, outwards});
        } else
          sides.push_back(CircularArc{from, to, offset, outwards});
      }
      return loop(sides);
    }
    case Shape::stadium:
      return stadium(size * dice.spread(1e-3, 1.0), size * dice.spread(0.05, 1.0), at);
    case Shape::mushroom: {
      const double cap = size * dice.between(0.5, 1.0);
      return mushroom(cap, cap * dice.between(0.05, 0.9), size * dice.between(0.1, 1.0));
    }
    case Shape::discs: {
      Table t = polygon({{at.x - size, at.y - size},
                         {at.x + size, at.y - size},
                         {at.x + size, at.y + size},
                         {at.x - size, at.y + size}});
      for (const double x : {-0.5, 0.5})
        for (const double y : {-0.5, 0.5})
          if (dice.coin())
            add_loop(
                t, {Circle{
                       {at.x + x * size, at.y + y * size}, size * dice.spread(1e-3, 0.49), false}});
      return t;
    }
    case Shape::annulus: {
      Table t = loop({Circle{at, size, true}});
      const double inner = size * dice.spread(0.01, 0.7), room = size - inner;
      const Vector d = dice.direction();
      const double away = room * dice.between(0.0, 0.99);
      add_loop(t, {Circle{{at.x + away * d.x, at.y + away * d.y}, inner, false}});
      return t;
    }
    default: {
      const Vector axis = size * dice.direction();
      Table t = loop({Ellipse{at, axis, dice.spread(0.1, 1.0), true}});
      if (dice.coin()) {  // with an elliptic obstacle inside
        const double r = std::get<Ellipse>(t.walls[0].curve).ratio;
        add_loop(t, {Ellipse{at, r * dice.between(0.1, 0.9) * size * dice.direction(),
                             dice.between(0.1, 1.0), false}});
      }
      return t;
    }
  }
}

/// A table whose outer wall, or an obstacle in a disc, is an ellipse, and the same with the ellipse
/// cut into 2 to 6 arcs. `exactly`: into two arcs of exactly one ellipse; else each, through
/// rounded joints, is of one of its own.
struct CutEllipse {
  Table whole, cut;
};
inline CutEllipse cut_ellipse(double size, bool obstacle, bool exactly, double thinnest,
                              Dice& dice) {
  constexpr double turn = 6.283185307179586;
  const int count = exactly ? 2 : dice.whole(2, 6);
  const Vector centre = exactly ? Vector{} : size * dice.between(0.0, 0.2) * dice.direction(),
               major = size * dice.direction();
  const double ratio = dice.spread(thinnest, 1.0), first = dice.between(0.0, turn);
  const auto point = [&](double angle) {
    return centre + std::cos(angle) * major + (ratio * std::sin(angle)) * left(major);
  };
  std::vector<double> angles;
  for (int i = 0; i < count; ++i)
    angles.push_back(first + turn / count * (i + dice.between(-0.3, 0.3)));
  angles.push_back(angles[0] + turn);
  std::vector<Vector> joints;
  for (int i = 0; i < count; ++i) joints.push_back(point(angles[static_cast<std::size_t>(i)]));
  if (exactly) joints[1] = -joints[0];
  joints.push_back(joints[0]);
  std::vector<Curve> arcs;
  for (std::size_t i = 0; i + 1 < joints.size(); ++i)
    arcs.push_back(exactly ? EllipticArc{joints[i], joints[i + 1], major, ratio, 0.0, true}
                           : geometry::elliptic_arc_through(
                                 joints[i], point(0.5 * (angles[i] + angles[i + 1])), joints[i + 1],
                                 major, ratio));
  if (!obstacle) return {loop({Ellipse{centre, major, ratio, true}}), loop(arcs)};
  std::reverse(arcs.begin(), arcs.end());
  for (Curve& arc : arcs) arc = geometry::reversed(arc);
  CutEllipse tables{loop({Circle{{0, 0}, 2.0 * size, true}}), {}};
  tables.cut = tables.whole;
  add_loop(tables.whole, {Ellipse{centre, major, ratio, false}});
  add_loop(tables.cut, arcs);
  return tables;
}

}  // namespace carom::tests
