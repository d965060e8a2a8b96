#include "certify/ball_table.hpp"

#include <array>
#include <string>

#include "carom/base/error.hpp"
#include "certify/exact_value.hpp"

namespace carom::certify {

WallOf<Ball> segment_wall(const BallVector& from, const BallVector& to) {
  WallOf<Ball> w;
  w.from = from;
  w.to = to;
  w.chord = to - from;
  w.normal = left(w.chord);
  w.double_inverse = Ball(2) / dot(w.chord, w.chord);
  return w;
}

WallOf<Ball> arc_wall(const BallVector& from, const BallVector& to, const BallVector& centre,
                      const Ball& radius2, bool counterclockwise) {
  WallOf<Ball> w;
  w.form = Form::circle;
  w.turn = counterclockwise ? 1.0 : -1.0;
  w.from = from;
  w.to = to;
  w.chord = to - from;
  w.centre = centre;
  w.radius2 = radius2;
  w.double_inverse = Ball(2) / radius2;
  return w;
}

WallOf<Ball> circle_wall(const BallVector& centre, const Ball& radius, bool counterclockwise) {
  const BallVector start{centre.x + radius, centre.y};
  WallOf<Ball> w = arc_wall(start, start, centre, square(radius), counterclockwise);
  w.closed = true;
  return w;
}

WallOf<Ball> ellipse_wall(const BallVector& centre, const BallVector& axis, const Ball& ratio,
                          bool counterclockwise) {
  WallOf<Ball> w;
  w.form = Form::ellipse;
  w.closed = true;
  w.turn = counterclockwise ? 1.0 : -1.0;
  w.from = w.to = centre + axis;
  w.centre = centre;
  // (P - C) . axis/a^2 is the coordinate in units of a; across: the other axis is ratio left(axis).
  const Ball a2 = dot(axis, axis);
  w.along = {axis.x / a2, axis.y / a2};
  const Ball scale = Ball(1) / (ratio * a2);
  w.across = {-(scale * axis.y), scale * axis.x};
  return w;
}

namespace {

class Builder {
 public:
  explicit Builder(const TableSpec& spec) : spec_(spec) {}

  BallTable build() {
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
    } else if (shape == "path") {
      for (const LoopSpec& loop : spec_.loops) path(loop);
    } else if (shape != "plane") {
      throw InputError(spec_.shape_place, "the shape '" + shape + "' has no certified form",
                       "another shape, or --precision double");
    }
    if (spec_.lattice) table_.lattice = {point(spec_.lattice->first), point(spec_.lattice->second)};
    return std::move(table_);
  }

 private:
  Ball number(const char* key) const {
    const auto found = spec_.numbers.find(key);
    return found == spec_.numbers.end() ? Ball(0) : value_of(found->second);
  }
  static BallVector point(const ExactPoint& p) { return {value_of(p.x), value_of(p.y)}; }
  std::vector<BallVector> points(const char* key) const {
    std::vector<BallVector> result;
    for (const ExactPoint& p : spec_.points.at(key)) result.push_back(point(p));
    return result;
  }
  void add(WallOf<Ball> w) { table_.walls.push_back(std::move(w)); }

  static std::vector<BallVector> rectangle(const Ball& w, const Ball& h) {
    return {{0, 0}, {w, 0}, {w, h}, {0, h}};
  }
  void polygon(const std::vector<BallVector>& corners) {
    for (std::size_t k = 0; k < corners.size(); ++k)
      add(segment_wall(corners[k], corners[(k + 1) % corners.size()]));
  }
  void regular() {
    const auto found = spec_.numbers.find("angle");
    const ExactNumber angle = found == spec_.numbers.end() ? ExactNumber() : found->second;
    const long n = static_cast<long>(spec_.numbers.at("sides").to_double());
    const Ball radius = number("radius");
    std::vector<BallVector> corners;
    for (long k = 0; k < n; ++k) {
      const CosSin d = direction_of(angle, k, n);
      corners.push_back({radius * d.cos, radius * d.sin});
    }
    polygon(corners);
  }
  void stadium() {
    const Ball a = number("half_length"), r = number("radius");
    const BallVector south_west{-a, -r}, south_east{a, -r}, north_east{a, r}, north_west{-a, r};
    add(segment_wall(south_west, south_east));
    add(arc_wall(south_east, north_east, {a, 0}, square(r), true));
    add(segment_wall(north_east, north_west));
    add(arc_wall(north_west, south_west, {-a, 0}, square(r), true));
  }
  void mushroom() {
    const Ball cap = number("cap_radius"), half = number("stem_width") / 2, height = number("stem_height");
    const BallVector foot_left{-half, -height}, foot_right{half, -height};
    const BallVector neck_right{half, 0}, neck_left{-half, 0}, cap_right{cap, 0}, cap_left{-cap, 0};
    // As in the table: whether there is a brim is read off the doubles.
    const bool brim = spec_.numbers.at("stem_width").to_double() / 2 < spec_.numbers.at("cap_radius").to_double();
    add(segment_wall(foot_left, foot_right));
    add(segment_wall(foot_right, neck_right));
    if (brim) add(segment_wall(neck_right, cap_right));
    add(arc_wall(cap_right, cap_left, {}, square(cap), true));
    if (brim) add(segment_wall(cap_left, neck_left));
    add(segment_wall(neck_left, foot_left));
  }
  void lemon() {
    const Ball r = number("radius"), d = number("separation");
    const Ball tip = sqrt(square(r) - square(d) / 4), half = d / 2;
    const BallVector south{0, -tip}, north{0, tip};
    add(arc_wall(south, north, {-half, 0}, square(r), true));
    add(arc_wall(north, south, {half, 0}, square(r), true));
  }
  void sinai() {
    const Ball side = number("side"), half = side / 2;
    add(circle_wall({half, half}, number("radius"), false));
    if (spec_.torus)
      table_.lattice = {{side, 0}, {0, side}};
    else
      polygon(rectangle(side, side));
  }
  void lorentz() {
    const Ball spacing = number("spacing");
    add(circle_wall({}, number("radius"), false));
    const auto word = spec_.words.find("lattice");
    if (word != spec_.words.end() && word->second == "square")
      table_.lattice = {{spacing, 0}, {0, spacing}};
    else
      table_.lattice = {{spacing, 0}, {spacing / 2, spacing * sqrt(Ball(3)) / 2}};
  }
  void discs() {
    const auto list = spec_.lists.find("radii");
    const std::vector<BallVector> centers = points("centers");
    for (std::size_t k = 0; k < centers.size(); ++k)
      add(circle_wall(centers[k], list == spec_.lists.end() ? number("radius") : value_of(list->second[k]), false));
  }
  void path(const LoopSpec& loop) {
    BallVector from = point(loop.start);
    for (const PieceSpec& piece : loop.pieces) {
      const BallVector to = point(piece.to);
      if (piece.kind == PieceSpec::Kind::line) add(segment_wall(from, to));
      if (piece.kind == PieceSpec::Kind::arc) add(arc_through(from, point(piece.via), to, piece.place));
      if (piece.kind == PieceSpec::Kind::ellipse)
        throw InputError(piece.place, "arcs of ellipses have no certified form",
                         "line_to, arc_to, a full ellipse; or --precision double");
      from = to;
    }
  }
  static WallOf<Ball> arc_through(const BallVector& from, const BallVector& via, const BallVector& to,
                                  const Place& place) {
    const BallVector c = to - from, f = via - from;
    const Ball turn = cross(f, c);  // > 0: counter-clockwise
    const Sign side = sign(turn);
    if (side != Sign::positive && side != Sign::negative)
      throw InputError(place, "no circular arc leads through these three points", "arc_via beside the line");
    // The centre lies at from + e with 2 e.c = c.c and 2 e.f = f.f.
    const Ball cc = dot(c, c), ff = dot(f, f), twice = Ball(2) * turn;
    const BallVector e{(ff * c.y - cc * f.y) / twice, (cc * f.x - ff * c.x) / twice};
    return arc_wall(from, to, from + e, dot(e, e), side == Sign::positive);
  }

  const TableSpec& spec_;
  BallTable table_;
};

}  // namespace

BallTable ball_table(const TableSpec& spec) { return Builder(spec).build(); }

}  // namespace carom::certify
