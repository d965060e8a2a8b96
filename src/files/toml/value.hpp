// A system file as a tree of values, each with its text and its place.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "carom/base/error.hpp"

namespace carom::files {

struct Entry;

struct Value {
  enum class Kind { number, text, boolean, list, table, other } kind = Kind::table;
  std::string text;  ///< a number as written, or a string's content
  bool flag = false;
  std::vector<Value> items;    ///< of a list
  std::vector<Entry> entries;  ///< of a table, in the order of the file
  Place place;

  Value* find(std::string_view key);
  const Value* find(std::string_view key) const;
  /// Adds or replaces an entry; the key's place is the value's.
  Value& set(const std::string& key, Value value);
  void erase(std::string_view key);
};

struct Entry {
  std::string key;
  Place place;
  Value value;
};

/// "a number", "a list" …
std::string name_of(Value::Kind kind);

/// Without content yet.
Value empty_value(Value::Kind kind, const Place& place);
Value number_value(std::string text, const Place& place);
Value text_value(std::string text, const Place& place);
Value flag_value(bool flag, const Place& place);

/// Parses a TOML document; syntax errors are an InputError with line and column.
Value parse_document(std::string_view toml, const std::string& file);
/// Parses one TOML value; what is none becomes a string ("1/3", a bare word).
Value parse_value(const std::string& text, const Place& place);

/// The tree as TOML: sections with headers, everything else in line.
std::string print_document(const Value& root);

}  // namespace carom::files
