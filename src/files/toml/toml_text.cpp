// The only file that includes the TOML parser.
#include <toml++/toml.h>

#include <algorithm>
#include <utility>

#include "files/text_file.hpp"
#include "files/toml/nesting.hpp"
#include "files/toml/value.hpp"

namespace carom::files {
namespace {

/// The text of a document by line and column. Columns count code points, not bytes.
class Source {
 public:
  explicit Source(std::string_view text) {
    for (std::size_t start = 0; start <= text.size();) {
      const std::size_t end = std::min(text.find('\n', start), text.size());
      lines_.push_back(text.substr(start, end - start));
      start = end + 1;
    }
    // A byte order mark is no column.
    if (lines_.front().substr(0, 3) == "\xEF\xBB\xBF") lines_.front().remove_prefix(3);
  }

  std::string cut(const toml::source_region& region) const {
    const std::string_view line = lines_.at(region.begin.line - 1);
    const std::size_t begin = byte_of(region.begin);
    const std::size_t end =
        region.end.line == region.begin.line ? byte_of(region.end) : line.size();
    return std::string(line.substr(begin, end - begin));
  }

 private:
  // Values come in order: from the last place on, so that a line of a million numbers is passed
  // once.
  std::size_t byte_of(const toml::source_position& place) const {
    const std::string_view line = lines_.at(place.line - 1);
    if (place.line != last_.line || place.column < last_.column) last_ = {place.line, 1, 0};
    for (; last_.column < place.column && last_.byte < line.size(); ++last_.column) {
      ++last_.byte;
      while (last_.byte < line.size() &&
             (static_cast<unsigned char>(line[last_.byte]) & 0xc0) == 0x80)
        ++last_.byte;
    }
    return last_.byte;
  }

  struct Last {
    std::size_t line = 0, column = 1, byte = 0;
  };
  std::vector<std::string_view> lines_;
  mutable Last last_;
};

class Converter {
 public:
  Converter(std::string_view text, std::string file) : source_(text), file_(std::move(file)) {}

  Value convert(const toml::node& node, const std::string& path) const {
    Value value;
    value.place = place(node.source(), path);
    if (const auto* table = node.as_table()) {
      value.kind = Value::Kind::table;
      value.entries = entries(*table, path);
    } else if (const auto* list = node.as_array()) {
      value.kind = Value::Kind::list;
      value.items.reserve(list->size());  // of a million, growing would take as much again
      for (std::size_t k = 0; k < list->size(); ++k) {
        value.items.push_back(convert((*list)[k], path + "[" + std::to_string(k) + "]"));
      }
    } else if (const auto* flag = node.as_boolean()) {
      value.kind = Value::Kind::boolean;
      value.flag = flag->get();
    } else if (const auto* text = node.as_string()) {
      value.kind = Value::Kind::text;
      value.text = text->get();
    } else if (node.is_number()) {
      value.kind = Value::Kind::number;
      value.text = source_.cut(node.source());
      const std::string prefix = value.text.substr(0, 2);
      if (prefix == "0x" || prefix == "0o" || prefix == "0b") {
        value.text = std::to_string(node.as_integer()->get());
      }
    } else {
      value.kind = Value::Kind::other;
    }
    return value;
  }

 private:
  Place place(const toml::source_region& region, const std::string& path) const {
    return {file_, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column),
            path};
  }

  // The parser sorts keys by name; the file's order reads better.
  std::vector<Entry> entries(const toml::table& table, const std::string& path) const {
    std::vector<Entry> result;
    for (const auto& [key, node] : table) {
      const std::string inner = (path.empty() ? "" : path + ".") + std::string(key.str());
      result.push_back({std::string(key.str()), place(key.source(), inner), convert(node, inner)});
    }
    std::stable_sort(result.begin(), result.end(), [](const Entry& a, const Entry& b) {
      return std::pair(a.place.line, a.place.column) < std::pair(b.place.line, b.place.column);
    });
    return result;
  }

  Source source_;
  std::string file_;
};

// All parts of the value are at one place; each keeps its own key.
void move_to(const Place& place, Value& value) {
  const auto move = [&](Place& moved) {
    moved = {place.file, place.line, place.column, moved.key};
  };
  move(value.place);
  for (Value& item : value.items) move_to(place, item);
  for (Entry& entry : value.entries) {
    move(entry.place);
    move_to(place, entry.value);
  }
}

}  // namespace

Value parse_document(std::string_view text, const std::string& file) {
  if (text.size() > most_of_system_file) throw too_long({file, 0, 0, ""}, most_of_system_file);
  check_nesting(text, file);
  try {
    const toml::table root = toml::parse(text, std::string_view(file));
    return Converter(text, file).convert(root, "");
  } catch (const toml::parse_error& error) {
    const auto begin = error.source().begin;
    throw InputError({file, static_cast<int>(begin.line), static_cast<int>(begin.column), ""},
                     "not valid TOML: " + std::string(error.description()));
  }
}

Value parse_value(const std::string& text, const Place& place) {
  check_nesting_of_value(text, place);
  const std::string document = "value = " + text;
  try {
    const toml::table root = toml::parse(std::string_view(document), std::string_view("value"));
    if (root.size() == 1) {
      Value value = Converter(document, "value").convert(*root.get("value"), place.key);
      move_to(place, value);
      return value;
    }
  } catch (const toml::parse_error&) {  // a bare word or an expression: a string, see below
  }
  return text_value(text, place);
}

}  // namespace carom::files
