// A bump's power series, and how far it can be trusted.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "carom/geometry/vector.hpp"
#include "forces/lattice_sum.hpp"

namespace carom::forces {

/// V = 1/(1 + exp((r - radius)/softness)) or V = exp(-r^2/(2 width^2)).
struct BumpShape {
  enum class Kind { fermi, gaussian } kind = Kind::fermi;
  double radius = 0.0, softness = 1.0;  ///< fermi
  double width = 1.0;                   ///< gaussian

  /// Its length of decay: a force is at most about 1 over this.
  double length() const { return kind == Kind::fermi ? softness : width; }
};

/// What Taylor's series of V about a point at the distance r from the centre leaves out beyond
/// degrees 0, 1,
/// ..., at points within `way` of it: upper bounds of the value's error and of length() times the
/// gradient's, infinite where none is known. They decrease with r.
using SeriesErrors = std::array<double, LatticeSum::most_degree + 1>;
SeriesErrors series_errors(const BumpShape&, double r, double way);

/// The polynomial of a total degree in X and Y that Taylor's series of V at d + X a + Y b gives,
/// added to `to`, where the coefficient of X^i Y^j is number i + width j.
void add_series(const BumpShape&, geometry::Vector d, geometry::Vector a, geometry::Vector b,
                int degree, std::size_t width, std::vector<double>& to);

}  // namespace carom::forces
