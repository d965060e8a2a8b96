// Small systems for the tests of this module.
#pragma once

#include <memory>
#include <string>

#include "carom/files/system_file.hpp"

namespace carom {

inline System make_system(const std::string& toml) { return read_system(toml, "test").system; }

inline const char* magnetic_square = R"(
[table]
shape = "rectangle"
width = 1
height = 1
[[table.hole]]
wall = "bottom"
center = 0.5
width = 0.3
[field]
larmor_radius = 0.5075
[initial]
kind = "uniform"
[run]
t_max = 200
trajectories = 500
)";

/// A box with a potential that is defined in its right half alone: steps over the edge fail.
/// Without [run].
inline const char* defined_in_the_right_half = R"toml(
[table]
shape = "rectangle"
width = 1
height = 1
[particles]
speed = 1
[initial]
kind = "rectangle"
min = [0.6, 0.1]
max = [0.9, 0.9]
[[potential]]
kind = "expression"
expression = "sqrt(x - 1/2)"
[integrator]
step = 0.01
)toml";

}  // namespace carom
