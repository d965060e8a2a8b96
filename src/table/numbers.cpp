#include "table/numbers.hpp"

#include <cmath>

namespace carom::table::shapes {
namespace {

// Fourth powers of lengths (quartics) and their products must stay far from the ends of the range.
constexpr double largest = 0x1p100;
constexpr double smallest = 0x1p-100;

}  // namespace

Place place_of(const TableSpec& spec, const std::string& key) {
  Place place = spec.shape_place;
  place.key = "table." + key;
  return place;
}

const ExactNumber& number(const TableSpec& spec, std::string_view name) {
  const std::string key(name);
  const auto found = spec.numbers.find(key);
  if (found == spec.numbers.end()) {
    throw InputError(place_of(spec, key), "the shape '" + spec.shape + "' needs '" + key + "'",
                     "a number");
  }
  return found->second;
}

ExactNumber number_or(const TableSpec& spec, const std::string& key, const char* fallback) {
  const auto found = spec.numbers.find(key);
  return found == spec.numbers.end() ? ExactNumber(fallback, place_of(spec, key)) : found->second;
}

double size_of(const ExactNumber& value, const std::string& name) {
  const double size = value.to_double();
  const std::string prefix = value.place().key.empty() ? name + " " : "";
  if (!(size > 0)) {
    throw InputError(value.place(), prefix + "must be positive, not " + value.text(),
                     "a number > 0");
  }
  if (!(size <= largest && size >= smallest)) {
    throw InputError(value.place(), prefix + "is out of range: " + value.text(),
                     "a length between 1e-30 and 1e30");
  }
  return size;
}

double size(const TableSpec& spec, const std::string& key) {
  return size_of(number(spec, key), key);
}

double coordinate(const ExactNumber& value) {
  const double x = value.to_double();
  if (!(std::fabs(x) <= largest)) {
    throw InputError(value.place(), "coordinate out of range: " + value.text(),
                     "a number between -1e30 and 1e30");
  }
  return x;
}

geometry::Vector point(const ExactPoint& value) {
  return {coordinate(value.x), coordinate(value.y)};
}

std::string quoted(const ExactNumber& value) {
  constexpr std::size_t long_text =
      2000;  // numbers made from doubles are shorter, and what was written means itself
  const auto rational = value.to_rational();
  const bool as_ratio =
      rational && rational->numerator.size() + rational->denominator.size() < long_text;
  return "(" + (as_ratio ? rational->numerator + "/" + rational->denominator : value.text()) + ")";
}

ExactNumber derived(const std::string& expression, const ExactNumber& origin) {
  return ExactNumber(expression, origin.place());
}

ExactNumber half(const ExactNumber& value) { return derived(quoted(value) + "/2", value); }
ExactNumber negative(const ExactNumber& value) { return derived("-" + quoted(value), value); }

}  // namespace carom::table::shapes
