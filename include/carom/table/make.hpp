// Tables made in code:
//   carom::polygon({{0, 0}, {2, 0}, {2, 1}, {0, 1}})
//       .hole("side_1", {.center = 1, .width = 0.2})
//       .obstacle(carom::disc({1, 0.5}, 0.2))
//
// A number is a double, which means exactly that double, or exact text: "1/3"_exact. Where shapes
// lie and what their walls are called: docs/guide/system-file.md.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "carom/table/table.hpp"
#include "carom/table/table_spec.hpp"

namespace carom {

/// A table with the numbers that it was made from. Each function checks the whole table
/// (docs/guide/system-file.md says of what) and throws InputError. Copies are cheap.
struct MadeTable {
  std::shared_ptr<const TableSpec> spec;  ///< what certified orbits start from
  std::shared_ptr<const Table> table;     ///< in doubles

  explicit MadeTable(TableSpec);
  MadeTable(TableSpec,
            const Place& where);  ///< `where`: place of an error in a number that has none
  operator const TableSpec&() const { return *spec; }  // NOLINT: a table is its specification
  operator const Table&() const { return *table; }     // NOLINT

  /// The same table with one hole, obstacle or lattice more.
  MadeTable hole(const std::string& wall, HoleSpec) const;
  MadeTable obstacle(ObstacleSpec, const std::string& name = "") const;
  MadeTable lattice(const ExactPoint& first, const ExactPoint& second) const;
};

MadeTable rectangle(const ExactNumber& width, const ExactNumber& height);
MadeTable polygon(std::vector<ExactPoint> points);
MadeTable regular_polygon(int sides, const ExactNumber& radius, const ExactNumber& angle = 0.0);
MadeTable circle(const ExactNumber& radius);
MadeTable ellipse(const ExactNumber& a, const ExactNumber& b);
MadeTable annulus(const ExactNumber& outer, const ExactNumber& inner,
                  const ExactNumber& offset = 0.0);
MadeTable stadium(const ExactNumber& half_length, const ExactNumber& radius);
MadeTable mushroom(const ExactNumber& cap_radius, const ExactNumber& stem_width,
                   const ExactNumber& stem_height);
MadeTable lemon(const ExactNumber& radius, const ExactNumber& separation);
/// r = radius (1 + cos phi).
MadeTable cardioid(const ExactNumber& radius);
/// r = radius (1 + epsilon cos phi), and with cos(petals phi).
MadeTable limacon(const ExactNumber& radius, const ExactNumber& epsilon);
MadeTable flower(const ExactNumber& radius, const ExactNumber& epsilon, int petals);
/// |x/a|^exponent + |y/b|^exponent = 1.
MadeTable superellipse(const ExactNumber& a, const ExactNumber& b, int exponent);
/// The image of the unit circle under z + lambda z^2, times the radius.
MadeTable robnik(const ExactNumber& radius, const ExactNumber& lambda);
/// x = a cos t, y = b sin t (1 + epsilon cos t).
MadeTable egg(const ExactNumber& a, const ExactNumber& b, const ExactNumber& epsilon);
MadeTable sinai(const ExactNumber& side, const ExactNumber& radius, bool torus = true);
/// `lattice`: triangular or square.
MadeTable lorentz(const ExactNumber& spacing, const ExactNumber& radius,
                  const std::string& lattice = "triangular");
/// In the open plane; lattice() repeats them.
MadeTable discs(std::vector<ExactPoint> centers, const ExactNumber& radius);
MadeTable discs(std::vector<ExactPoint> centers, std::vector<ExactNumber> radii);
MadeTable path(std::vector<LoopSpec> loops);

/// Obstacles, for MadeTable::obstacle.
ObstacleSpec disc(const ExactPoint& center, const ExactNumber& radius);
/// `angle`: of the semi-axis a against +x, in radians.
ObstacleSpec elliptic_disc(const ExactPoint& center, const ExactNumber& a, const ExactNumber& b,
                           const ExactNumber& angle = 0.0);
/// A polygon, its corners listed either way round.
ObstacleSpec block(std::vector<ExactPoint> points);

}  // namespace carom
