// The billiard table: walls, joints, holes and an optional lattice.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "carom/forces/typed_expression.hpp"
#include "carom/geometry/curve.hpp"
#include "carom/geometry/lattice.hpp"
#include "carom/table/table_spec.hpp"

namespace carom {

/// An opening [from, to) of a wall, in its parameter u; exact once stored.
struct Hole {
  std::string name;
  int wall = 0;
  double from = 0.0, to = 0.0;
  double transmission = 1.0;  ///< the share of hits that pass; the others are those of its wall
};

/// An oriented piece of curve with the domain on its left.
struct Wall {
  std::string name;
  geometry::Curve curve;
  int next = 0;      ///< wall that begins where this one ends (itself for a closed curve)
  int previous = 0;  ///< wall that ends where this one begins
  /// n when the corner at this wall's start is declared to have the angle pi/n (0: not declared).
  int corner = 0;
  /// The share of hits that are mirrored; the others leave by Lambert's law (World::scatter_by).
  double specularity = 1.0;
  /// Mirrored at a normal that is turned by a random angle, uniform from -roughness to roughness.
  double roughness = 0.0;
  /// As an energy: where it is not 0, particles leave as those of a gas that is so hot, with
  /// another speed than they came with.
  double temperature = 0.0;
  /// The same piece of curve seen from the other side, of a wall between two regions; -1: none.
  int twin = -1;
  bool closed = false;     ///< It has a twin, but particles do not pass.
  std::vector<int> holes;  ///< indices into Table::holes, ordered by parameter
};

/// Where the walls may lead: a bounded domain, the outside of obstacles in the open plane, or the
/// cell of a lattice whose edges lead to the neighbouring cells.
enum class Extent { bounded, open_plane, lattice };

/// A part of the table with another magnetic field, another potential or another refractive index,
/// behind walls that particles pass (docs/physics/regions.md).
struct Region {
  /// Its walls as seen from within, one after the other in Table::walls, behind all that are seen
  /// from outside of all regions.
  int first = 0, count = 0;
  std::optional<double> field;  ///< B; none: as outside
  double index = 1.0;      ///< refractive index relative to the outside: the speed is speed/index
  double potential = 0.0;  ///< an energy; outside it is 0
  /// Which fraction of the hits is mirrored although they could pass: none; that of a wave whose
  /// amplitude is continuous, with its normal derivative (s) or that over index squared (p); or
  /// `fraction`.
  enum class Reflection : unsigned char { none, s, p, typed } reflection = Reflection::none;
  /// Of the angles to the normal before the edge and behind it, and of the ratio of the momenta
  /// behind it and before it.
  std::optional<TypedExpression> fraction;
};

/// By how much walls differ from the curves that were written as formulas, at most and without
/// rounding: in place, in the angle of their normals and, except beside cusps, in curvature.
struct CurveErrors {
  double distance = 0.0, normal = 0.0, curvature = 0.0;
};

/// A billiard table: its walls, the holes on them, and the plane or lattice around.
struct Table {
  std::string shape;
  std::vector<Wall> walls;
  std::vector<Hole> holes;
  std::vector<Region> regions;
  Extent extent = Extent::bounded;
  std::optional<geometry::Lattice> lattice;  ///< set exactly when extent == lattice
  /// May walls cross? Not those of a table that was built; the edges of supports of forces do.
  bool crossing = false;
  CurveErrors curve_errors;

  /// The wall with that index, as events and states name it. Throws std::out_of_range for -1: no
  /// wall.
  const Wall& wall(int index) const { return walls.at(static_cast<std::size_t>(index)); }
  /// Index of the wall or hole with that name, or -1.
  int wall_index(const std::string& name) const;
  int hole_index(const std::string& name) const;
};

/// Do particles pass that wall?
inline bool is_passed(const Wall& wall) { return wall.twin >= 0 && !wall.closed; }
/// The number of the region that a wall is seen from, -1: from outside of all.
int region_of(const Table&, int wall);
/// The walls that are seen from a region (-1: from outside of all), as a table of its own.
Table seen_from(const Table&, int region);
/// Is the wall that side of a region's edge that is seen from within?
bool is_inner_side(const Table&, int wall);

/// Is what happens at a wall random?
bool scatters(const Table&);
/// Do walls change the speeds of particles?
bool is_thermal(const Table&);
/// Do its regions, because of an index or a potential?
bool regions_change_speeds(const Table&);
/// Throws InputError if walls do, or if particles pass some. `what`: cannot be had with such walls.
void refuse_all_but_mirrors(const Table&, const char* what);

/// Area of the domain (of one cell for a lattice; infinity for the open plane), total length of the
/// walls, and the mean flight pi A / L of the closed billiard without field; NaN where regions
/// change speeds, for then it is another one in each.
struct TableMeasure {
  double area = 0.0, perimeter = 0.0, mean_flight = 0.0;
};
/// Measures the walls of a table that was built.
TableMeasure measure(const Table&);

/// Builds a table from its specification: named shapes become walls, holes become parameters, and
/// the region is checked exactly (closed, simple, oriented, obstacles inside and apart).
/// Throws InputError at the place of the fault.
Table build_table(const TableSpec&);

}  // namespace carom
