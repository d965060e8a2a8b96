#include "files/toml/sweep_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <optional>

#include "base/parts.hpp"
#include "carom/base/elementary.hpp"
#include "carom/base/exact_number.hpp"
#include "carom/base/whole_number.hpp"
#include "carom/system/report_times.hpp"
#include "files/toml/overrides.hpp"

namespace carom::files {

namespace {

constexpr const char* notation = "KEY=lin:FROM:TO:COUNT, KEY=log:FROM:TO:COUNT or KEY=list:a,b,c";

ExactNumber number_of(const std::string& text, const Place& place) {
  try {
    ExactNumber number(text, place);
    number.to_double();
    return number;
  } catch (const InputError&) {
    throw InputError(place, fmt::format("'{}' is not a number", text),
                     "numbers such as 0.2, 1e-3, 1/3 or pi/4");
  }
}

// "0.125" for 1/8, "1/3" for a third: the shortest text of a rational number that means exactly it.
std::string written(const RationalText& number) {
  if (number.denominator == "1") return number.numerator;
  const std::string quotient = number.numerator + "/" + number.denominator;
  // A decimal with at most 15 digits is the shortest text of the double nearest to it.
  const std::string decimal = fmt::format("{}", ExactNumber(quotient).to_double());
  const auto same = ExactNumber(decimal).to_rational();
  return same && same->numerator == number.numerator && same->denominator == number.denominator
             ? decimal
             : quotient;
}
std::string written(const std::string& expression) {
  const auto rational = ExactNumber(expression).to_rational();
  return rational ? written(*rational) : expression;
}

std::vector<std::string> linear(const ExactNumber& from, const ExactNumber& to,
                                std::uint64_t count) {
  std::vector<std::string> values;
  for (std::uint64_t i = 0; i < count; ++i)
    values.push_back(i == 0           ? written(from.text())
                     : i + 1 == count ? written(to.text())
                                      : written(fmt::format("({0})+(({1})-({0}))*{2}/{3}",
                                                            from.text(), to.text(), i, count - 1)));
  return values;
}

// The factor between neighbours where it is a short decimal, as in log:1:1000:4.
std::optional<std::string> exact_factor(const ExactNumber& from, const ExactNumber& to,
                                        std::uint64_t count) {
  constexpr std::uint64_t most_exact = 64;  // a higher power has more digits than a double can use
  if (count > most_exact || !from.to_rational() || !to.to_rational()) return {};
  const double ratio = to.to_double() / from.to_double();
  const double near = elementary::exp(elementary::log(ratio) / static_cast<double>(count - 1));
  const std::string factor = fmt::format("{:.10g}", near);
  const auto end =
      ExactNumber(fmt::format("({})*({})^{}-({})", from.text(), factor, count - 1, to.text()))
          .to_rational();
  return end && end->numerator == "0" ? std::optional(factor) : std::nullopt;
}

std::vector<std::string> logarithmic(const ExactNumber& from, const ExactNumber& to,
                                     std::uint64_t count) {
  const auto factor = exact_factor(from, to, count);
  const std::vector<double> near = spaced(from.to_double(), to.to_double(), count, true);
  std::vector<std::string> values;
  for (std::uint64_t i = 0; i < count; ++i) {
    if (i == 0 || i + 1 == count)
      values.push_back(written((i == 0 ? from : to).text()));
    else if (factor)
      values.push_back(written(fmt::format("({})*({})^{}", from.text(), *factor, i)));
    else
      values.push_back(fmt::format("{}", near[i]));
  }
  return values;
}

std::vector<std::string> between(const std::vector<std::string>& parts, const Place& place) {
  const ExactNumber from = number_of(parts[1], place), to = number_of(parts[2], place);
  const auto count = whole_number(number_of(parts[3], place), 2, most_swept);
  if (!count)
    throw InputError(place, fmt::format("'{}' is not a number of values", parts[3]),
                     fmt::format("a whole number from 2 to {}", most_swept));
  if (parts[0] == "lin") return linear(from, to, *count);
  if (!(from.to_double() > 0.0 && to.to_double() > 0.0))
    throw InputError(place,
                     fmt::format("'{}' has no logarithm", parts[from.to_double() > 0.0 ? 2 : 1]),
                     "FROM and TO above 0, or lin:FROM:TO:COUNT");
  return logarithmic(from, to, *count);
}

}  // namespace

SweptKey swept_key(const std::string& typed) {
  const std::size_t equals = typed.find('=');
  if (equals == 0 || equals == std::string::npos)
    throw InputError(Place{command_line_file, 0, 0, "--sweep"},
                     fmt::format("cannot read '{}'", typed), notation);
  SweptKey swept{typed.substr(0, equals), {}};
  const Place place{command_line_file, 0, 0, "--sweep " + swept.key};
  const std::string asked = typed.substr(equals + 1), list = "list:";
  if (asked.starts_with(list)) {
    swept.values = base::parts_of(asked.substr(list.size()), ',');
    for (std::string& value : swept.values) value = number_of(value, place).text();
  } else {
    const std::vector<std::string> parts = base::parts_of(asked, ':');
    const std::array<const char*, 2> spacings{"lin", "log"};
    if (std::find(spacings.begin(), spacings.end(), parts[0]) == spacings.end())
      throw InputError(place, fmt::format("cannot read the values '{}'", asked), notation,
                       nearest_name(parts[0], {"lin", "log", "list"}));
    if (parts.size() != 4)
      throw InputError(place, fmt::format("cannot read the values '{}'", asked),
                       parts[0] + ":FROM:TO:COUNT");
    swept.values = between(parts, place);
  }
  if (swept.values.size() > most_swept)
    throw InputError(place, fmt::format("{} values are too many", swept.values.size()),
                     fmt::format("at most {}", most_swept));
  std::vector<double> sorted;
  for (const std::string& value : swept.values) sorted.push_back(ExactNumber(value).to_double());
  std::sort(sorted.begin(), sorted.end());
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
  if (twice != sorted.end())
    throw InputError(place, fmt::format("the value {} is given twice", *twice),
                     "values that differ");
  return swept;
}

}  // namespace carom::files
