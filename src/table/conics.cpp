// Circle, ellipse, annulus.
#include <cmath>

#include "table/numbers.hpp"
#include "table/shapes.hpp"

namespace carom::shapes {

using geometry::Circle;
using geometry::Vector;

void circle(const TableSpec& spec, Table& table) {
  add_loop(table, {{"circle", Circle{Vector{0, 0}, size(spec, "radius"), true}}});
}

void ellipse(const TableSpec& spec, Table& table) {
  const ExactNumber& a = number(spec, "a");
  const ExactNumber& b = number(spec, "b");
  const double semi_axis = size_of(a, "a");
  size_of(b, "b");
  const double ratio = size_of(derived(quoted(b) + "/" + quoted(a), b), "b/a");
  add_loop(table, {{"ellipse", geometry::Ellipse{Vector{0, 0}, Vector{semi_axis, 0}, ratio, true}}});
}

void annulus(const TableSpec& spec, Table& table) {
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
  add_loop(table, {{"outer", Circle{Vector{0, 0}, outer, true}}});
  add_loop(table, {{"inner", Circle{Vector{offset, 0}, inner, false}}});
}

}  // namespace carom::shapes
