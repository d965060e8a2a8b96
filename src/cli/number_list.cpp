#include "cli/number_list.hpp"

#include <fmt/format.h>

#include <cstdint>

#include "base/parts.hpp"
#include "carom/base/error.hpp"
#include "carom/base/exact_number.hpp"
#include "carom/system/report_times.hpp"
#include "cli/common.hpp"

namespace carom::cli {

std::vector<double> numbers_of(const std::string& text, const char* option, const char* what,
                               const char* expected) {
  const Place place{"command line", 0, 0, option};
  const bool grid = text.find(':') != std::string::npos;
  const std::vector<std::string> parts = base::parts_of(text, grid ? ':' : ',');
  const auto number = [&](const std::string& part) { return ExactNumber(part, place).to_double(); };
  std::vector<double> numbers;
  if (!grid) {
    for (const std::string& part : parts) numbers.push_back(number(part));
    return numbers;
  }
  const bool log = parts[0] == "log";
  if (parts.size() != 4 || (!log && parts[0] != "lin"))
    throw InputError(place, fmt::format("cannot read the {} '{}'", what, text), expected);
  const double first = number(parts[1]), last = number(parts[2]);
  const std::uint64_t count = whole_number(parts[3], option, 2);
  if (!(first < last) || (log && !(first > 0.0)) || count > 1'000'000)
    throw InputError(place, fmt::format("cannot read the {} '{}'", what, text),
                     fmt::format("from < to, at most 1e6 {}", what));
  return spaced(first, last, count, log);
}

}  // namespace carom::cli
