// The named shapes: each function adds the walls of one shape to a table.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "carom/table/table.hpp"

namespace carom::shapes {

/// A wall before it has neighbours.
struct NamedCurve {
  std::string name;
  geometry::Curve curve;
  int corner = 0;  ///< n if the corner at its start is declared to have the angle pi/n
};

/// Adds a chain of curves, each of which ends where the next begins and the last where the first
/// begins. A full circle or ellipse is a chain of one.
void add_loop(Table& table, std::vector<NamedCurve> chain);
/// Adds a polygon whose side k runs from corner k to the next; the corners' angle may be declared.
void add_polygon(Table& table, const std::vector<std::string>& names,
                 const std::vector<geometry::Vector>& corners, int corner = 0);
/// "side_1", "side_2", …
std::vector<std::string> numbered(const std::string& stem, std::size_t count);

void rectangle(const TableSpec& spec, Table& table);
void polygon(const TableSpec& spec, Table& table);
void triangle(const TableSpec& spec, Table& table);
void regular(const TableSpec& spec, Table& table);

void circle(const TableSpec& spec, Table& table);
void ellipse(const TableSpec& spec, Table& table);
void annulus(const TableSpec& spec, Table& table);

void stadium(const TableSpec& spec, Table& table);
void mushroom(const TableSpec& spec, Table& table);
void lemon(const TableSpec& spec, Table& table);

void sinai(const TableSpec& spec, Table& table);
void lorentz(const TableSpec& spec, Table& table);
void discs(const TableSpec& spec, Table& table);
void random_discs(const TableSpec& spec, Table& table);
/// The square [0, side]^2 about discs: a torus, or with walls.
void close_square(Table& table, double side, const TableSpec& spec);
/// No walls: for particles that forces hold, or on a lattice.
void plane(const TableSpec& spec, Table& table);
/// [lattice]: repeats the obstacles of any open table.
void repeat(const LatticeSpec& lattice, Table& table);

void path(const TableSpec& spec, Table& table);

/// The walls of [[table.obstacle]], after those of the shape.
void add_obstacles(const TableSpec& spec, Table& table);

/// Turns the holes' arc lengths into parameters.
void add_holes(const TableSpec& spec, Table& table);

/// Are arcs bent enough for hits in doubles? docs/physics/exactness.md, Flat arcs.
void refuse_flat_arcs(const TableSpec& spec, const Table& table);
/// Where a wall was written: its obstacle, corner, centre or piece if it has one, else the table.
Place place_of_wall(const TableSpec& spec, const Table& table, std::size_t wall);

/// Is the table a region: closed, simple, oriented, obstacles inside and apart? Exact.
void check_region(const TableSpec& spec, const Table& table);

}  // namespace carom::shapes
