// A random system: what Carom is given as a TOML file and the reference computes by formulas of its
// own. Mass and charge are 1. Every number is a double that the file holds to its last digit.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace resolution {

/// One summand of the potential. s = a x + b y - c where a line is meant, r the distance from (a,
/// b).
struct Term {
  enum class Shape {
    gaussian,   ///< height exp(-r²/(2 width²))
    rational,   ///< height / (1 + r²/width²)
    ridge,      ///< height exp(-s²/(2 width²))
    soft_wall,  ///< height exp(-s/width)
    edge,       ///< height (1 - tanh(s/width))/2
    wave,       ///< height cos(s)
    peaks,      ///< height exp(c (cos(a x) + cos(b y) - 2))
    linear,     ///< -(a x + b y)
    fermi,      ///< height / (1 + exp((r - c)/width)), and its copies on the lattice; r from the
                ///< lattice points
    bells       ///< height exp(-r²/(2 width²)), and its copies on the lattice
  };
  Shape shape = Shape::gaussian;
  double height = 0.0, width = 0.0, a = 0.0, b = 0.0, c = 0.0;
};

struct System {
  std::string family;
  std::vector<Term> terms;
  bool box = false, lattice = false;
  double width = 0.0, height = 0.0;    ///< of the box [0, width] x [0, height]
  std::array<double, 4> vectors = {};  ///< of the lattice: x and y of the first, of the second
  double field = 0.0;                  ///< B: a = B (v_y, -v_x)
  std::array<double, 4> start = {};    ///< x, y, v_x, v_y
  double scale = 0.0;                  ///< shortest length over which a force changes
  double longest_time = 0.0;           ///< the orbit ends here, if it is not too unstable before
};

/// The system that this seed and index mean, in any order of calls.
System random_system(std::uint64_t seed, std::uint64_t index);

/// The file that Carom reads; `integrator` holds the lines of [integrator].
std::string toml(const System& system, double t_max, const std::string& integrator);

}  // namespace resolution
