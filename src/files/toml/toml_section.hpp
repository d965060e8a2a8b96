// Reads the values of one section, guided by the table of keys.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "carom/base/exact_number.hpp"
#include "carom/files/system_file.hpp"
#include "carom/geometry/vector.hpp"
#include "carom/table/table_spec.hpp"
#include "files/toml/value.hpp"

namespace carom::files {

// One value of the expected type each, or an InputError at its place.
ExactNumber as_number(const Value& value);
double as_double(const Value& value);
/// An angle in radians: a number of at most a full turn, or a text with a unit, "45 deg" or "2
/// rad". A larger number without a unit is refused: it may be degrees.
ExactNumber as_angle(const Value& value);
double as_positive(const Value& value);
std::uint64_t as_count(const Value& value, std::uint64_t least, std::uint64_t most = UINT64_MAX);
const std::string& as_text(const Value& value);
/// The name of a wall, a hole or an obstacle: it is shown in messages, tables and pictures.
const std::string& as_name(const Value& value);
bool as_flag(const Value& value);
ExactPoint as_point(const Value& value);
geometry::Vector as_vector(const Value& value);
std::vector<ExactNumber> as_numbers(const Value& value);
std::vector<ExactPoint> as_points(const Value& value);
const Value& as_list(const Value& value);
/// A list of sections [[NAME]]; the message to others shows `example`, the first line of one.
const Value& as_sections(const Value& value, const std::string& example);

/// A section of the file. Defaults that are asked for are written into it, so that afterwards the
/// tree is the resolved system.
class TomlSection {
 public:
  /// `name`: the section's name in key_table(); `kind`: shape or kind, "" while unknown.
  TomlSection(Value& table, std::string name, std::string kind = "");

  /// An InputError unless every key of the section is known for its kind.
  void check_keys() const;

  Value& value() { return table_; }
  bool has(std::string_view key) const { return table_.find(key) != nullptr; }
  /// The value of a key, or null.
  Value* find(std::string_view key) { return table_.find(key); }
  /// The value of a key, its default, or an InputError that it is missing.
  Value& get(std::string_view key);
  /// Writes a default that the table of keys cannot know.
  Value& fill(const std::string& key, Value fallback);
  /// At most one of two keys may be written.
  void exclude(std::string_view one, std::string_view other) const;

  const std::string& kind() const { return kind_; }
  Place place_of(std::string_view key) const;

 private:
  const KeyDescription* description(std::string_view key) const;
  void refuse_other_kind(const Entry& unknown) const;

  Value& table_;
  std::string name_, kind_;
};

/// Is `kind` one of the kinds "a|b|c" (or are all meant)?
bool of_kind(const KeyDescription& description, std::string_view kind);
/// Reads which of the kinds of a section is meant ("shape" or "kind"); unknown ones are an
/// InputError.
std::string read_kind(Value& table, const std::string& section, const std::string& key,
                      const std::vector<std::string>& kinds);
/// "a, b, c"
std::string listed(const std::vector<std::string>& words);
/// A number with six digits, for messages.
std::string shown(double x);

}  // namespace carom::files
