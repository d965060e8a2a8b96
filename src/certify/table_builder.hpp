// Tables as they were written, in any arithmetic that can enclose or hold the numbers of a system file.
#pragma once

#include <string>
#include <variant>

#include "carom/base/error.hpp"
#include "carom/table/table.hpp"
#include "certify/ball_table.hpp"
#include "table/obstacles.hpp"

namespace carom::certify {

/// How an arithmetic N takes numbers that were written: value(number), and direction(angle, part, whole), the
/// cosine and sine of an angle plus a part of whole turns.
template <class N>
struct Source;

/// Is the stem of a mushroom narrower than its cap? By the numbers as written; an InputError where it is wider.
bool has_brim(const TableSpec&);

template <class N>
class TableBuilder {
 public:
  explicit TableBuilder(const TableSpec& spec) : spec_(spec) {}

  TableOf<N> build() {
    const std::string& shape = spec_.shape;
    if (shape == "rectangle") {
      polygon(rectangle(number("width"), number("height")));
    } else if (shape == "polygon" || shape == "triangle") {
      polygon(points("points"));
    } else if (shape == "regular") {
      regular();
    } else if (shape == "circle") {
      add(circle_wall({}, number("radius"), true));
    } else if (shape == "ellipse") {
      add(ellipse_wall({}, {number("a"), 0}, number("b") / number("a"), true));
    } else if (shape == "annulus") {
      add(circle_wall({}, number("outer"), true));
      add(circle_wall({number("offset"), 0}, number("inner"), false));
    } else if (shape == "stadium") {
      stadium();
    } else if (shape == "mushroom") {
      mushroom();
    } else if (shape == "lemon") {
      lemon();
    } else if (shape == "sinai") {
      sinai();
    } else if (shape == "lorentz") {
      lorentz();
    } else if (shape == "discs") {
      discs();
    } else if (shape == "random-discs") {
      random_discs();
    } else if (shape == "path") {
      for (const LoopSpec& loop : spec_.loops) path(loop);
    } else if (shape != "plane") {
      throw InputError(spec_.shape_place, "the shape '" + shape + "' has no certified form",
                       "another shape, or --precision double");
    }
    for (const ObstacleSpec& obstacle : spec_.obstacles) add_obstacle(obstacle);
    if (spec_.lattice) table_.lattice = {point(spec_.lattice->first), point(spec_.lattice->second)};
    return std::move(table_);
  }

 private:
  N number(const char* key) const {
    const auto found = spec_.numbers.find(key);
    return found == spec_.numbers.end() ? N(0) : Source<N>::value(found->second);
  }
  static VectorOf<N> point(const ExactPoint& p) { return {Source<N>::value(p.x), Source<N>::value(p.y)}; }
  std::vector<VectorOf<N>> points(const char* key) const {
    std::vector<VectorOf<N>> result;
    for (const ExactPoint& p : spec_.points.at(key)) result.push_back(point(p));
    return result;
  }
  void add(WallOf<N> w) { table_.walls.push_back(std::move(w)); }

  static std::vector<VectorOf<N>> rectangle(const N& w, const N& h) {
    return {{0, 0}, {w, 0}, {w, h}, {0, h}};
  }
  void polygon(const std::vector<VectorOf<N>>& corners) {
    for (std::size_t k = 0; k < corners.size(); ++k)
      add(segment_wall(corners[k], corners[(k + 1) % corners.size()]));
  }
  void regular() {
    const auto found = spec_.numbers.find("angle");
    const ExactNumber angle = found == spec_.numbers.end() ? ExactNumber() : found->second;
    const long n = static_cast<long>(spec_.numbers.at("sides").to_double());
    const N radius = number("radius");
    std::vector<VectorOf<N>> corners;
    for (long k = 0; k < n; ++k) {
      const VectorOf<N> d = Source<N>::direction(angle, k, n);
      corners.push_back({radius * d.x, radius * d.y});
    }
    polygon(corners);
  }
  void stadium() {
    const N a = number("half_length"), r = number("radius");
    const VectorOf<N> south_west{-a, -r}, south_east{a, -r}, north_east{a, r}, north_west{-a, r};
    add(segment_wall(south_west, south_east));
    add(arc_wall(south_east, north_east, {a, 0}, square(r), true));
    add(segment_wall(north_east, north_west));
    add(arc_wall(north_west, south_west, {-a, 0}, square(r), true));
  }
  void mushroom() {
    const N cap = number("cap_radius"), half = number("stem_width") / 2, height = number("stem_height");
    const VectorOf<N> foot_left{-half, -height}, foot_right{half, -height};
    const VectorOf<N> neck_right{half, 0}, neck_left{-half, 0}, cap_right{cap, 0}, cap_left{-cap, 0};
    const bool brim = has_brim(spec_);
    add(segment_wall(foot_left, foot_right));
    add(segment_wall(foot_right, neck_right));
    if (brim) add(segment_wall(neck_right, cap_right));
    add(arc_wall(cap_right, cap_left, {}, square(cap), true));
    if (brim) add(segment_wall(cap_left, neck_left));
    add(segment_wall(neck_left, foot_left));
  }
  void lemon() {
    const N r = number("radius"), d = number("separation");
    const N tip = sqrt(square(r) - square(d) / 4), half = d / 2;
    const VectorOf<N> south{0, -tip}, north{0, tip};
    add(arc_wall(south, north, {-half, 0}, square(r), true));
    add(arc_wall(north, south, {half, 0}, square(r), true));
  }
  void sinai() {
    const N side = number("side"), half = side / 2;
    add(circle_wall({half, half}, number("radius"), false));
    square_around(side);
  }
  void lorentz() {
    const N spacing = number("spacing");
    add(circle_wall({}, number("radius"), false));
    const auto word = spec_.words.find("lattice");
    if (word != spec_.words.end() && word->second == "square")
      table_.lattice = {{spacing, 0}, {0, spacing}};
    else
      table_.lattice = {{spacing, 0}, {spacing / 2, spacing * sqrt(N(3)) / 2}};
  }
  void discs() {
    const auto list = spec_.lists.find("radii");
    const std::vector<VectorOf<N>> centers = points("centers");
    for (std::size_t k = 0; k < centers.size(); ++k)
      add(circle_wall(centers[k],
                      list == spec_.lists.end() ? number("radius") : Source<N>::value(list->second[k]),
                      false));
  }
  // Centres are drawn as doubles, and are these exactly.
  void random_discs() {
    TableSpec closed = spec_;
    closed.obstacles.clear();
    closed.holes.clear();
    for (const Wall& wall : build_table(closed).walls)
      if (const auto* disc = std::get_if<geometry::Circle>(&wall.curve))
        add(circle_wall({N(disc->centre.x), N(disc->centre.y)}, number("radius"), false));
    square_around(number("side"));
  }
  void square_around(const N& side) {
    if (spec_.torus)
      table_.lattice = {{side, 0}, {0, side}};
    else
      polygon(rectangle(side, side));
  }
  void add_obstacle(const ObstacleSpec& o) {
    if (o.shape == ObstacleSpec::Shape::polygon) {
      for (const ClockwiseSide& s : clockwise_sides(o)) add(segment_wall(point(o.points[s.from]), point(o.points[s.to])));
    } else if (o.shape == ObstacleSpec::Shape::circle) {
      add(circle_wall(point(o.center), Source<N>::value(o.radius), false));
    } else {
      const N a = Source<N>::value(o.a);
      add(ellipse_wall(point(o.center), a * Source<N>::direction(o.angle), Source<N>::value(o.b) / a, false));
    }
  }
  void path(const LoopSpec& loop) {
    VectorOf<N> from = point(loop.start);
    for (const PieceSpec& piece : loop.pieces) {
      const VectorOf<N> to = point(piece.to);
      if (piece.kind == PieceSpec::Kind::line) add(segment_wall(from, to));
      if (piece.kind == PieceSpec::Kind::arc) add(arc_through(from, point(piece.via), to, piece.place));
      if (piece.kind == PieceSpec::Kind::ellipse) add(elliptic_arc(from, piece));
      from = to;
    }
  }
  static WallOf<N> arc_through(const VectorOf<N>& from, const VectorOf<N>& via, const VectorOf<N>& to,
                               const Place& place) {
    const VectorOf<N> c = to - from, f = via - from;
    const N turn = cross(f, c);  // > 0: counter-clockwise
    const Sign side = sign(turn);
    if (side != Sign::positive && side != Sign::negative)
      throw InputError(place, "no arc leads through these three points", "a point beside the line");
    // The centre lies at from + e with 2 e.c = c.c and 2 e.f = f.f.
    const N cc = dot(c, c), ff = dot(f, f), twice = N(2) * turn;
    const VectorOf<N> e{(ff * c.y - cc * f.y) / twice, (cc * f.x - ff * c.x) / twice};
    return arc_wall(from, to, from + e, dot(e, e), side == Sign::positive);
  }
  // In the frame of its axes, the minor one stretched, it is an arc of a circle.
  static WallOf<N> elliptic_arc(const VectorOf<N>& from, const PieceSpec& piece) {
    const VectorOf<N> axis = Source<N>::direction(piece.angle), other = left(axis);
    const N ratio = Source<N>::value(piece.ratio);
    const auto seen = [&](const VectorOf<N>& P) { return VectorOf<N>{dot(P, axis), dot(P, other) / ratio}; };
    const VectorOf<N> to = point(piece.to);
    const WallOf<N> circle = arc_through(seen(from), seen(point(piece.via)), seen(to), piece.place);
    const VectorOf<N> centre = circle.centre.x * axis + (ratio * circle.centre.y) * other;
    return elliptic_arc_wall(from, to, centre, sqrt(circle.radius2) * axis, ratio, circle.turn > 0);
  }

  const TableSpec& spec_;
  TableOf<N> table_;
};

}  // namespace carom::certify
