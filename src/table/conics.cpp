// Circle, ellipse, annulus.
#include <cmath>

#include "table/numbers.hpp"
#include "table/shapes.hpp"

namespace carom::table::shapes {

Shape circle(const TableSpec& spec) {
  size(spec, "radius");
  return {{{{"circle", WrittenCircle{{}, number(spec, "radius"), true}}}}};
}

Shape ellipse(const TableSpec& spec) {
  size(spec, "a");
  size(spec, "b");
  return {{{{"ellipse", WrittenEllipse{{}, number(spec, "a"), number(spec, "b"), {}, true}}}}};
}

Shape annulus(const TableSpec& spec) {
  const double outer = size(spec, "outer");
  const ExactNumber& inner_number = number(spec, "inner");
  const double inner = size_of(inner_number, "inner");
  const ExactNumber offset_number = number_or(spec, "offset", "0");
  const double offset = coordinate(offset_number);
  if (inner >= outer) {
    throw InputError(inner_number.place(), "the inner circle does not fit into the outer one",
                     "inner < outer");
  }
  if (inner + std::fabs(offset) > outer) {
    throw InputError(offset_number.place(), "the inner circle sticks out of the outer one",
                     "inner + |offset| <= outer");
  }
  return {{{{"outer", WrittenCircle{{}, number(spec, "outer"), true}}},
           {{"inner", WrittenCircle{{offset_number, 0}, inner_number, false}}}}};
}

}  // namespace carom::table::shapes
