// A table as it was written: plain data whose values carry their place in the file.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "carom/base/exact_number.hpp"

namespace carom {

/// A point with exact coordinates.
struct ExactPoint {
  ExactNumber x, y;
};

/// One piece of a path: which keys are set decides its kind (docs/guide/system-file.md: line_to,
/// arc_via + arc_to, ellipse_via + ellipse_to + ellipse_ratio + ellipse_angle, bezier).
struct PieceSpec {
  enum class Kind { line, arc, ellipse, bezier } kind = Kind::line;
  ExactPoint to;
  ExactPoint via;                   ///< arc, ellipse
  ExactNumber ratio, angle;         ///< ellipse: minor over major axis, angle of the major one
  std::vector<ExactPoint> control;  ///< bezier: the points between its ends
  std::string name;                 ///< "" : wall_1, wall_2 … over the whole table
  Place place;
};

/// One closed path of walls: pieces, or a whole circle or ellipse as an outer wall.
struct LoopSpec {
  ExactPoint start;
  std::vector<PieceSpec> pieces;  ///< the last must end at `start`
  Place place;
  enum class Kind { pieces, circle, ellipse } kind = Kind::pieces;
  ExactPoint center = {};
  ExactNumber radius = {}, a = {}, b = {}, angle = {};  ///< as of an obstacle
  std::string name = {};  ///< of a circle or an ellipse, as of a piece
};

/// An expression that was written, and where.
struct WrittenFormula {
  std::string text;
  Place place;
};

/// A hole as the system file gives it.
struct HoleSpec {
  std::string wall = {};
  ExactNumber center, width;  ///< arc lengths along the wall
  std::string name = {};      ///< "" : hole_1, hole_2 …
  double transmission = 1.0;  ///< Hole::transmission
  Place place = {}, wall_place = {};
};

/// "hole_1", "hole_2" … where none is given.
inline std::string name_of_hole(const std::vector<HoleSpec>& holes, std::size_t index) {
  return holes[index].name.empty() ? "hole_" + std::to_string(index + 1) : holes[index].name;
}

/// An obstacle as the system file gives it: a circle has a center and a radius; an ellipse a
/// center, the semi-axes a and b, and the angle of a against +x in radians; a polygon and a spline
/// have points, a path a loop of pieces; a polar curve has a center and a formula of its radius, a
/// parametric one has formulas of x and y. All may run either way round.
struct ObstacleSpec {
  enum class Shape {
    circle,
    ellipse,
    polygon,
    path,
    polar,
    parametric,
    spline
  } shape = Shape::circle;
  ExactPoint center;
  ExactNumber radius, a, b, angle;
  std::vector<ExactPoint> points;
  LoopSpec loop;
  WrittenFormula radius_formula, x, y;
  std::optional<ExactNumber> from, to;  ///< 0 and 2 pi
  std::string name;                     ///< "" : obstacle_1, obstacle_2 …
  Place place;
};

/// How a wall reflects, as the system file gives it.
struct WallLawSpec {
  std::string wall;          ///< "" : all walls
  double specularity = 1.0;  ///< Wall::specularity
  double roughness = 0.0;    ///< Wall::roughness
  double temperature = 0.0;  ///< Wall::temperature
  Place place, wall_place;
};

/// A region as the system file gives it.
struct RegionSpec {
  std::string wall;  ///< of the obstacle that it fills; "" : it lies on the left of `edge`
  LoopSpec edge;     ///< from a corner of the walls to another one
  ExactNumber index, potential;
  std::optional<ExactNumber> field;
  WrittenFormula reflection;  ///< a word or a formula; "": none
  Place place, wall_place;
};

/// The two vectors of a lattice.
struct LatticeSpec {
  ExactPoint first, second;
  Place place;
};

/// `numbers`, `points`, `lists` and `words` hold the keys of the shape by name
/// (docs/guide/system-file.md): width, height, radius, sides, angle, a, b, outer, inner, offset,
/// half_length, cap_radius, stem_width, stem_height, separation, side, spacing, count, seed;
/// points, centers; radii; lattice.
struct TableSpec {
  std::string shape;
  Place place, shape_place;
  std::map<std::string, ExactNumber> numbers;
  std::map<std::string, std::vector<ExactPoint>> points;
  std::map<std::string, std::vector<ExactNumber>> lists;
  std::map<std::string, std::string> words;
  std::map<std::string, WrittenFormula> formulas;  ///< polar: radius; parametric: x, y
  bool torus = true;                               ///< sinai, random-discs
  std::vector<LoopSpec> loops;                     ///< path
  std::vector<ObstacleSpec> obstacles;
  std::vector<HoleSpec> holes;
  std::vector<WallLawSpec> laws;  ///< the last that names a wall holds
  std::vector<RegionSpec> regions;
  std::optional<LatticeSpec> lattice;
};

}  // namespace carom
