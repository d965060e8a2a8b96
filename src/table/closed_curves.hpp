// Closed curves as they are written, for tables (counter-clockwise) and obstacles (clockwise).
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "table/shapes.hpp"

namespace carom::table::shapes {

struct ClosedCurve {
  Chain chain;
  CurveErrors errors = {};
};
/// What its walls are called, STEM_1, STEM_2 …, and how they run.
struct Layout {
  std::string stem = "curve";
  bool clockwise = false;
};

/// A closed curve as it is written: r(phi) about a centre, or x(t) and y(t).
struct CurveFormulas {
  bool polar = false;
  WrittenFormula first, second = {};  ///< the radius and nothing, or x and y
  std::map<std::string, ExactNumber> numbers =
      {};  ///< by the names that the formulas have for them
  ExactNumber from = {}, to = ExactNumber("2*pi");
  ExactPoint centre = {};  ///< polar
};
/// Of a shape whose outer wall is one, and of an obstacle; nothing of others.
std::optional<CurveFormulas> formulas_of(const TableSpec&);
std::optional<CurveFormulas> formulas_of(const ObstacleSpec&);

ClosedCurve drawn(const CurveFormulas&, const Layout&);

/// The points of a spline in the order of its walls.
struct SplinePoint {
  ExactPoint at;
  std::size_t side;  ///< the number of the wall from here on, as it was written
};
std::vector<SplinePoint> points_in_order(const std::vector<ExactPoint>&, bool clockwise);
/// The periodic cubic spline through points; wall k leads from point k to the next or back. A fault
/// that is none of a point is at `place`.
Chain spline(const std::vector<ExactPoint>& points, const Place& place, const Layout&);
/// The pieces of a path in their order; `name(k)`: of piece k where it has none of its own.
Chain chain_of_pieces(const LoopSpec&, const std::function<std::string(std::size_t)>& name);
/// The same of a path that is closed.
Chain loop_of_pieces(const LoopSpec&, const std::function<std::string(std::size_t)>& name);

/// The area within, negative where the chain runs clockwise.
double area_of(const Chain&);
/// The chain run through backwards.
Chain reversed(Chain);
/// The chain, turned round if it runs the other way. Of pieces and Bézier curves.
Chain turned(Chain, bool clockwise);

}  // namespace carom::table::shapes
