// Systems that several tests of the program use.
#pragma once

#include <string>

namespace carom {

/// Four unlike discs on a torus; [run] is open, with a sample each half unit of time.
inline const std::string discs_on_a_torus = R"([lattice]
vectors = [[4, 0], [0, 4]]
[interaction]
kind = "hard-discs"
radii = [0.5, 0.3, 0.4, 0.6]
[particles]
mass = [1, 2, 3, "1/3"]
speed = [1, 0.5, 0, 2]
[initial]
kind = "uniform"
[run]
sample = 0.5
)";

}  // namespace carom
