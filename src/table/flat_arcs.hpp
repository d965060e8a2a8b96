// Arcs that are too flat for hits in doubles: docs/physics/exactness.md, Flat arcs.
#pragma once

#include <string>

#include "carom/table/table.hpp"

namespace carom::table {

/// Why a wall is too flat an arc; "" if it is not.
std::string flat_arc(const Wall&);
inline constexpr const char* bent_enough =
    "a straight line, or an arc bent enough for a share of 2^-16: a radius up to some 30000 chords";

}  // namespace carom::table
