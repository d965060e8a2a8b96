#include "carom/base/error.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "printable.hpp"

namespace carom {
namespace {

std::string message(const Place& place, const std::string& problem, const std::string& expected,
                    const std::string& nearest) {
  std::string text = describe(place);
  if (!text.empty()) text += ": ";
  text += problem;
  // A long list of names is of no use beside the right one.
  constexpr std::size_t long_list = 100;
  const bool shown = !expected.empty() && (nearest.empty() || expected.size() < long_list);
  if (!shown && nearest.empty()) return text;
  text += " (";
  if (shown) text += "expected " + expected;
  if (shown && !nearest.empty()) text += "; ";
  if (!nearest.empty()) text += "did you mean '" + nearest + "'?";
  return text + ")";
}

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

// Insertions, deletions, replacements and swaps of two neighbours, one each (optimal string
// alignment); the case of letters does not count. Three rows of the table are kept.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before(b.size() + 1), above(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::swap(before, above);
    std::swap(above, row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool same = lower(a[i - 1]) == lower(b[j - 1]);
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (same ? 0 : 1)});
      const bool swapped = i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) &&
                           lower(a[i - 2]) == lower(b[j - 1]);
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
    }
  }
  return row[b.size()];
}

}  // namespace

std::string describe(const Place& place) {
  std::string text = place.file;
  const auto append = [&text](const std::string& part) {
    text += (text.empty() ? "" : ", ") + part;
  };
  if (place.line > 0) append("line " + std::to_string(place.line));
  if (place.line > 0 && place.column > 0) append("column " + std::to_string(place.column));
  if (place.key.empty()) return text;
  return text.empty() ? place.key : text + ": " + place.key;
}

InputError::InputError(Place place, std::string problem, std::string expected, std::string nearest)
    : std::runtime_error(base::printable(message(place, problem, expected, nearest))),
      place_(std::move(place)),
      problem_(std::move(problem)),
      expected_(std::move(expected)),
      nearest_(std::move(nearest)) {}

std::string nearest_name(const std::string& word, const std::vector<std::string>& candidates) {
  std::string nearest;
  std::size_t least = 0;
  for (const std::string& candidate : candidates) {
    const std::size_t longer = std::max(word.size(), candidate.size());
    const std::size_t shorter = std::min(word.size(), candidate.size());
    // One slip in three letters is near; names of one letter have no near ones but their capitals.
    const std::size_t near = longer < 2 ? 0 : (longer + 2) / 3;
    if (shorter == 0 || longer - shorter > near) continue;
    const std::size_t distance = edit_distance(word, candidate);
    if (distance > near || distance >= longer) continue;
    if (nearest.empty() || distance < least) {
      nearest = candidate;
      least = distance;
    }
  }
  return nearest;
}

}  // namespace carom
