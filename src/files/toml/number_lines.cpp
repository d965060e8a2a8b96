#include "files/toml/number_lines.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "files/text_file.hpp"
#include "files/toml/overrides.hpp"

namespace carom::files {
namespace {

constexpr std::size_t most_rows = 1000000;
/// A number with a thousand digits has its place; what is no text has no lines.
constexpr std::size_t longest_line = 65536;

bool digit(char c) { return c >= '0' && c <= '9'; }

/// Is it a decimal as TOML has them? Most are, and need no parser.
bool is_decimal(const std::string& text) {
  std::size_t i = 0;
  const auto digits = [&] {
    const std::size_t first = i;
    while (i < text.size() && digit(text[i])) ++i;
    return i > first;
  };
  if (i < text.size() && (text[i] == '-' || text[i] == '+')) ++i;
  const std::size_t whole = i;
  if (!digits() || (text[whole] == '0' && i > whole + 1)) return false;
  if (i < text.size() && text[i] == '.') {
    ++i;
    if (!digits()) return false;
  }
  if (i < text.size() && (text[i] == 'e' || text[i] == 'E')) {
    ++i;
    if (i < text.size() && (text[i] == '-' || text[i] == '+')) ++i;
    if (!digits()) return false;
  }
  return i == text.size();
}

std::string counted(std::size_t n) {
  static constexpr const char* words[] = {"no", "one", "two", "three", "four"};
  return n < 5 ? words[n] : std::to_string(n);
}

}  // namespace

std::string located(const Value& path) {
  const std::filesystem::path written(path.text);
  if (written.is_absolute() || path.place.file == command_line_file) return written.string();
  return (std::filesystem::path(path.place.file).parent_path() / written).string();
}

Value numbers_of_line(std::string line, const Place& place) {
  line.erase(std::min(line.find('#'), line.size()));
  Value row;
  row.kind = Value::Kind::list;
  row.place = place;
  for (std::size_t i = 0; i < line.size();) {
    const std::size_t begin = line.find_first_not_of(", \t\r", i);
    if (begin == std::string::npos) break;
    i = std::min(line.find_first_of(", \t\r", begin), line.size());
    Place here = place;
    here.column = static_cast<int>(begin) + 1;
    std::string text = line.substr(begin, i - begin);
    row.items.push_back(is_decimal(text) ? number_value(std::move(text), here)
                                         : parse_value(text, here));
  }
  return row;
}

Value rows_of_file(const std::string& name, const Place& key, const Row& row) {
  const std::string numbers(row.numbers);
  const std::string text = text_of_file(name, most_of_number_file, key, "'" + name + "' ",
                                        "a text file with " + numbers + " in each line");
  Value rows;
  rows.kind = Value::Kind::list;
  rows.place = key;
  std::size_t begin = 0;
  for (int number = 1; begin < text.size(); ++number) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    if (end - begin > longest_line)
      throw InputError({name, number, 1, ""},
                       "a line of " + std::to_string(end - begin) + " characters",
                       numbers + ", at most " + std::to_string(longest_line) + " characters");
    std::string line = text.substr(begin, end - begin);
    begin = end + 1;
    // Some editors begin a file with a byte-order mark.
    if (number == 1 && line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);
    Value one = numbers_of_line(std::move(line), {name, number, 1, ""});
    const std::size_t count = one.items.size();
    if (count == 0) continue;
    if (count < row.least || count > row.most) {
      const std::string range = row.least == row.most
                                    ? counted(row.least)
                                    : counted(row.least) + " or " + counted(row.most);
      throw InputError(one.place,
                       "a " + std::string(row.name) + " has " + range +
                           " numbers, but the line has " + std::to_string(count),
                       numbers);
    }
    if (rows.items.size() == most_rows)
      throw InputError(one.place, "too many " + std::string(row.name) + "s",
                       "at most " + std::to_string(most_rows));
    rows.items.push_back(std::move(one));
  }
  if (rows.items.empty())
    throw InputError({name, 0, 0, ""}, "the file holds no " + std::string(row.name),
                     numbers + " in each line");
  return rows;
}

}  // namespace carom::files
