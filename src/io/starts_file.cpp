#include "io/starts_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

#include "io/overrides.hpp"
#include "io/section.hpp"

namespace carom::io {
namespace {

constexpr std::size_t most_starts = 1000000;

/// Paths are relative to the system file's folder, those of the command line to the present one.
std::string located(const Value& path) {
  const std::filesystem::path written(path.text);
  if (written.is_absolute() || path.place.file == command_line_file) return written.string();
  return (std::filesystem::path(path.place.file).parent_path() / written).string();
}

/// The numbers of a line: "x y vx vy", parted by blanks or commas; # begins a comment.
Value start_of(std::string line, const Place& place) {
  line.erase(std::min(line.find('#'), line.size()));
  Value start;
  start.kind = Value::Kind::list;
  start.place = place;
  for (std::size_t i = 0; i < line.size();) {
    const std::size_t begin = line.find_first_not_of(", \t\r", i);
    if (begin == std::string::npos) break;
    i = std::min(line.find_first_of(", \t\r", begin), line.size());
    Place here = place;
    here.column = static_cast<int>(begin) + 1;
    start.items.push_back(parse_value(line.substr(begin, i - begin), here));
  }
  return start;
}

Value starts_in(const std::string& name, const Place& key) {
  std::error_code none;
  std::ifstream file(name);
  if (!file || std::filesystem::is_directory(name, none)) {
    throw InputError(key, "'" + name + "' cannot be read: " + (file ? "it is a folder" : std::strerror(errno)),
                     "a text file with x y vx vy in each line");
  }
  Value starts;
  starts.kind = Value::Kind::list;
  starts.place = key;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    Value start = start_of(line, {name, number, 1, ""});
    if (start.items.empty()) continue;
    if (start.items.size() != 4)
      throw InputError(start.place, "a start has four numbers, but the line has " + std::to_string(start.items.size()),
                       "x y vx vy");
    if (starts.items.size() == most_starts)
      throw InputError(start.place, "too many starts", "at most " + std::to_string(most_starts));
    starts.items.push_back(std::move(start));
  }
  if (starts.items.empty()) throw InputError({name, 0, 0, ""}, "the file holds no start", "x y vx vy in each line");
  return starts;
}

}  // namespace

void take_starts_from_file(Value& initial) {
  const Value* kind = initial.find("kind");
  if (kind == nullptr || kind->text != "file") return;
  Section section(initial, "initial", "file");
  section.check_keys();
  const Value& path = section.get("path");
  as_text(path);
  Value starts = starts_in(located(path), path.place);
  initial.find("kind")->text = "list";
  initial.erase("path");
  initial.set("starts", std::move(starts));
}

}  // namespace carom::io
