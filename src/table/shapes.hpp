// The named shapes: each function gives the walls of one shape in the numbers that were written.
// Tables round these to doubles (build.cpp), certified orbits enclose them
// (certify/wall/table_builder.hpp).
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "carom/table/table.hpp"

namespace carom::table::shapes {

/// A corner of a regular polygon: `radius` from the origin, in the direction of `angle` and `part`
/// of `whole` turns.
struct RegularCorner {
  ExactNumber radius, angle;
  int part = 0, whole = 1;
};
using WrittenPoint = std::variant<ExactPoint, RegularCorner>;

struct WrittenSegment {
  WrittenPoint from, to;
};
/// Counter-clockwise about its centre, which lies `offset` chords on the left of the chord. Half
/// circles have offset 0: their tangents at the ends are exactly at right angles to the chord, so
/// that they join straight walls without a corner.
struct WrittenArc {
  ExactPoint from, to, centre;
  ExactNumber radius, offset;
};
struct WrittenCircle {
  ExactPoint centre;
  ExactNumber radius;
  bool counterclockwise = false;
};
/// `angle`: of the semi-axis a against +x.
struct WrittenEllipse {
  ExactPoint centre;
  ExactNumber a, b, angle;
  bool counterclockwise = false;
};
/// A piece of a path.
struct WrittenPiece {
  ExactPoint from;
  PieceSpec piece;
};
using WrittenCurve = std::variant<WrittenSegment, WrittenArc, WrittenCircle, WrittenEllipse,
                                  WrittenPiece, geometry::Bezier>;

/// A wall before it has neighbours.
struct NamedCurve {
  std::string name;
  WrittenCurve curve;
  int corner = 0;               ///< n if the corner at its start is declared to have the angle pi/n
  double from = 0.0, to = 1.0;  ///< Of a curve of formulas: the parameters at its ends.
};
/// Curves of which each ends where the next begins and the last where the first begins. A full
/// circle or ellipse is a chain of one.
using Chain = std::vector<NamedCurve>;

struct Shape {
  std::vector<Chain> loops;
  Extent extent = Extent::bounded;
  std::optional<LatticeSpec> lattice = {};
  ExactPoint cell_centre = {};
  CurveErrors curve_errors = {};
};

/// The shape of a table with its obstacles and its lattice.
Shape written_shape(const TableSpec&);
/// A curve in doubles.
geometry::Curve rounded(const WrittenCurve&);

/// Adds a polygon whose side k runs from corner k to the next; the corners' angle may be declared.
void add_polygon(Shape&, const std::vector<std::string>& names,
                 const std::vector<WrittenPoint>& corners, int corner = 0);
/// "side_1", "side_2", …
std::vector<std::string> numbered(const std::string& stem, std::size_t count);

Shape rectangle(const TableSpec&);
Shape polygon(const TableSpec&);
Shape regular(const TableSpec&);

Shape circle(const TableSpec&);
Shape ellipse(const TableSpec&);
Shape annulus(const TableSpec&);

Shape stadium(const TableSpec&);
Shape mushroom(const TableSpec&);
Shape lemon(const TableSpec&);

Shape sinai(const TableSpec&);
Shape lorentz(const TableSpec&);
Shape discs(const TableSpec&);
Shape random_discs(const TableSpec&);
/// The square [0, side]^2 about discs: a torus, or with walls.
void close_square(Shape&, const ExactNumber& side, const TableSpec&);
/// No walls: for particles that forces hold, or on a lattice.
Shape plane(const TableSpec&);
/// Repeats the obstacles of an open table: those of a shape about the cell's centre, or of any by
/// [lattice].
void set_lattice(Table&, const LatticeSpec&, geometry::Vector centre);
void repeat(const LatticeSpec&, Table&);

Shape path(const TableSpec&);
/// A closed curve r(phi), or x(t) and y(t), typed or with a name of its own, as Bézier curves.
Shape curve_of_formulas(const TableSpec&);
/// The closed curve on which a formula of x and y vanishes.
Shape implicit_curve(const TableSpec&);
/// The periodic cubic spline through points, twice continuously differentiable.
Shape spline_curve(const TableSpec&);

/// The walls of [[table.obstacle]], after those of the shape.
void add_obstacles(const TableSpec&, Shape&);

/// Turns the holes' arc lengths into parameters.
void add_holes(const TableSpec& spec, Table& table);
void add_laws(const TableSpec& spec, Table& table);
/// The wall of that name; InputError at the place where there is none.
int named_wall(const std::string& name, const Place& place, const Table& table);
/// The same, or all walls NAME_1, NAME_2 … where none is called NAME.
std::vector<int> walls_named(const std::string& name, const Place& place, const Table& table);
/// These in the order in which they follow each other, from where the numbers begin. InputError if
/// they do not.
std::vector<int> stretch_named(const std::string& name, const Place& place, const Table& table);
/// Divides a table into its regions and what is outside of them. Walls that particles pass get a
/// twin each, which is seen from within. `nested`: obstacles lie in obstacles.
void divide(const TableSpec& spec, Table& table, bool nested);

/// Are arcs bent enough, ellipses thick and circles large enough for hits in doubles?
/// docs/physics/exactness.md, Flat arcs and Thin walls.
void refuse_misplaced(const TableSpec& spec, const Table& table);
/// Where a wall was written: its obstacle, corner, centre or piece if it has one, else the table.
Place place_of_wall(const TableSpec& spec, const Table& table, std::size_t wall);

/// Is the table a region: closed, simple, oriented, obstacles inside and apart? Exact. True if it
/// is, except obstacles inside obstacles, which may be regions.
bool check_region(const TableSpec& spec, const Table& table);
/// The same of a part of a table, whose walls have their places by name.
void check_part(const Table& part, const std::function<Place(const std::string&)>& place_of);

}  // namespace carom::table::shapes
