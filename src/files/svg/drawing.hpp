// A drawing (SVG) as closed curves.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "files/svg/pen.hpp"

namespace carom::files {

/// A closed curve of a drawing with the names of its walls, "" where an element has no id.
struct DrawnLoop {
  table::shapes::Chain chain;
  Place place;
};

/// All closed curves of a drawing, magnified, with y upwards. What bounds nothing is an InputError.
std::vector<DrawnLoop> loops_of_drawing(std::string_view svg, const std::string& file,
                                        const Rational& scale);

/// Joins strokes whose ends are equal. `strokes` that are closed already stay.
std::vector<DrawnLoop> joined(std::vector<Stroke> strokes);

}  // namespace carom::files
