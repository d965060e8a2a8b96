// Numbers of a specification, rounded once and checked.
#pragma once

#include <string>
#include <string_view>

#include "carom/geometry/vector.hpp"
#include "carom/table/table_spec.hpp"

namespace carom::table::shapes {

/// The number under a key; a missing one is an InputError at the shape.
const ExactNumber& number(const TableSpec& spec, std::string_view name);
/// The same, or a value to fall back on.
ExactNumber number_or(const TableSpec& spec, const std::string& key, const char* fallback);

/// A length: finite and positive, and neither so large nor so small that its powers leave the
/// range of doubles.
double size_of(const ExactNumber& value, const std::string& name);
double size(const TableSpec& spec, const std::string& key);
/// A coordinate: any sign, bounded as a length is.
double coordinate(const ExactNumber& value);
geometry::Vector point(const ExactPoint& value);

/// The number that an expression of other numbers means, exactly; it keeps the place of `origin`.
ExactNumber derived(const std::string& expression, const ExactNumber& origin);
/// A number as part of an expression: "(1/10)", "(sqrt(2))". Exact: the text of a number made from
/// a double is not.
std::string quoted(const ExactNumber& value);

/// Half of a number, and its negative.
ExactNumber half(const ExactNumber&);
ExactNumber negative(const ExactNumber&);

/// The place of a key of the table that was not written.
Place place_of(const TableSpec& spec, const std::string& key);

}  // namespace carom::table::shapes
