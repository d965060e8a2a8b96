#include "files/toml/toml_section.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/printable.hpp"
#include "carom/base/whole_number.hpp"
#include "files/toml/overrides.hpp"

namespace carom::files {
namespace {

[[noreturn]] void wrong_type(const Value& value, const std::string& expected) {
  throw InputError(value.place, "must be " + expected + ", not " + name_of(value.kind));
}

}  // namespace

ExactNumber as_number(const Value& value) {
  if (value.kind != Value::Kind::number && value.kind != Value::Kind::text) {
    wrong_type(value, "a number such as 0.5 or \"1/3\"");
  }
  ExactNumber number(value.text, value.place);
  number.to_double();  // out of range: say so here, with the place
  return number;
}

ExactNumber as_angle(const Value& value) {
  if (value.kind == Value::Kind::text) {
    for (const auto& [unit, factor] : {std::pair{"deg", "*pi/180"}, std::pair{"rad", ""}}) {
      if (!value.text.ends_with(unit)) continue;
      const std::string number = value.text.substr(0, value.text.size() - 3);
      ExactNumber(number, value.place).to_double();  // faults count the characters that were typed
      return {"(" + number + ")" + factor, value.place};
    }
  }
  const ExactNumber angle = as_number(value);
  if (std::fabs(angle.to_double()) <= 6.2831853071795862)  // the double above 2 pi
    return angle;
  throw InputError(value.place, "an angle of " + value.text + " is more than a full turn",
                   "radians up to 2 pi, or a text with a unit: \"" + value.text + " deg\", \"" +
                       value.text + " rad\"");
}

double as_double(const Value& value) { return as_number(value).to_double(); }

double as_positive(const Value& value) {
  const double x = as_double(value);
  if (!(x > 0))
    throw InputError(value.place, "must be positive, not " + value.text, "a number > 0");
  return x;
}

namespace {

// A whole number that 64 bits do not hold?
bool is_too_large(const Value& value) {
  try {
    const auto number = ExactNumber(value.text, value.place).to_rational();
    return number && number->denominator == "1" && number->numerator.size() >= 20 &&
           number->numerator.front() != '-';
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace

std::uint64_t as_count(const Value& value, std::uint64_t least, std::uint64_t most) {
  const std::string expected =
      most == UINT64_MAX
          ? "a whole number of at least " + std::to_string(least)
          : "a whole number from " + std::to_string(least) + " to " + std::to_string(most);
  if (value.kind != Value::Kind::number && value.kind != Value::Kind::text)
    wrong_type(value, expected);
  try {
    if (const auto count = whole_number(ExactNumber(value.text, value.place), least, most))
      return *count;
  } catch (const InputError&) {  // the reason would speak of sqrt and pi
  }
  const bool too_large = most == UINT64_MAX && is_too_large(value);
  throw InputError(value.place, "must be " + (too_large ? "a whole number below 2^64" : expected) +
                                    ", not " + value.text);
}

const std::string& as_text(const Value& value) {
  if (value.kind != Value::Kind::text) wrong_type(value, "a string in quotes");
  return value.text;
}

const std::string& as_name(const Value& value) {
  if (base::printable(as_text(value)) != value.text)
    throw InputError(value.place, "the name '" + value.text + "' has invisible characters",
                     "a name without control characters");
  return value.text;
}

bool as_flag(const Value& value) {
  if (value.kind != Value::Kind::boolean) wrong_type(value, "true or false");
  return value.flag;
}

const Value& as_list(const Value& value) {
  if (value.kind != Value::Kind::list) wrong_type(value, "a list");
  return value;
}

const Value& as_sections(const Value& value, const std::string& example) {
  if (value.kind != Value::Kind::list)
    throw InputError(
        value.place, "must be a list of sections, not " + name_of(value.kind),
        "[[" + value.place.key + "]] with two brackets, and below it, say, " + example);
  return value;
}

ExactPoint as_point(const Value& value) {
  if (value.kind != Value::Kind::list || value.items.size() != 2) {
    throw InputError(value.place,
                     value.kind == Value::Kind::list
                         ? "a point has two coordinates, not " + std::to_string(value.items.size())
                         : "must be a point, not " + name_of(value.kind),
                     "a point [x, y]");
  }
  return {as_number(value.items[0]), as_number(value.items[1])};
}

geometry::Vector as_vector(const Value& value) {
  const ExactPoint point = as_point(value);
  return {point.x.to_double(), point.y.to_double()};
}

std::vector<ExactNumber> as_numbers(const Value& value) {
  std::vector<ExactNumber> numbers;
  for (const Value& item : as_list(value).items) numbers.push_back(as_number(item));
  return numbers;
}

std::vector<ExactPoint> as_points(const Value& value) {
  if (value.kind != Value::Kind::list) wrong_type(value, "a list of points [x, y]");
  std::vector<ExactPoint> points;
  for (const Value& item : value.items) points.push_back(as_point(item));
  return points;
}

std::string listed(const std::vector<std::string>& words) {
  std::string list;
  for (const std::string& word : words) list.append(list.empty() ? "" : ", ").append(word);
  return list;
}

std::string shown(double x) {
  std::array<char, 32> buffer{};
  char* const begin = buffer.data();
  return {begin, std::to_chars(begin, begin + buffer.size(), x, std::chars_format::general, 6).ptr};
}

bool of_kind(const KeyDescription& description, std::string_view kind) {
  std::string_view kinds = description.kind;
  if (kinds.empty()) return true;
  while (!kinds.empty()) {
    const std::size_t end = std::min(kinds.find('|'), kinds.size());
    if (kinds.substr(0, end) == kind) return true;
    kinds.remove_prefix(std::min(end + 1, kinds.size()));
  }
  return false;
}

TomlSection::TomlSection(Value& table, std::string name, std::string kind)
    : table_(table), name_(std::move(name)), kind_(std::move(kind)) {
  if (table_.kind != Value::Kind::table) wrong_type(table_, "a section [" + name_ + "]");
  // Room for every default at once: references to values stay valid while others are filled in.
  table_.entries.reserve(table_.entries.size() + key_table().size());
}

const KeyDescription* TomlSection::description(std::string_view key) const {
  for (const KeyDescription& d : key_table()) {
    if (d.section == name_ && d.key == key && of_kind(d, kind_)) return &d;
  }
  return nullptr;
}

// A kind that was set on the command line beside the keys of another one: all that must go, and
// how.
void TomlSection::refuse_other_kind(const Entry& unknown) const {
  const Value* kind = nullptr;
  for (const char* key : {"kind", "shape"})
    if (kind == nullptr) kind = table_.find(key);
  if (kind_.empty() || kind == nullptr || kind->place.file != command_line_file ||
      unknown.place.file == command_line_file)
    return;
  std::vector<std::string> others, own;
  for (const Entry& entry : table_.entries)
    if (description(entry.key) == nullptr && entry.place.file != command_line_file)
      others.push_back("'" + entry.key + "'");
  std::string needed;
  for (const KeyDescription& d : key_table()) {
    if (d.section != name_ || !of_kind(d, kind_)) continue;
    own.emplace_back(d.key);
    if (table_.find(d.key) == kind) needed = std::string(d.key) + "=\"" + kind_ + "\"";
  }
  const std::string& path = table_.place.key;
  throw InputError(unknown.place,
                   "'" + kind_ + "' was set beside " + listed(others) + " of another kind",
                   (own.size() > 1 ? "one of " : "only ") + listed(own) + "; --set '" + path +
                       "={" + needed + (own.size() > 1 ? ", …" : "") + "}' replaces the whole");
}

void TomlSection::check_keys() const {
  for (const Entry& entry : table_.entries) {
    if (description(entry.key) != nullptr) continue;
    refuse_other_kind(entry);
    std::vector<std::string> known, elsewhere;
    for (const KeyDescription& d : key_table()) {
      if (d.section != name_) continue;
      if (of_kind(d, kind_)) {
        known.emplace_back(d.key);
      } else if (d.key == entry.key) {
        std::string kinds(d.kind);
        for (std::size_t at = 0; (at = kinds.find('|', at)) != std::string::npos;)
          kinds.replace(at, 1, ", ");
        elsewhere.push_back(kinds);
      }
    }
    std::string problem = "unknown key '" + entry.key + "'";
    if (!kind_.empty()) problem += " for '" + kind_ + "'";
    if (!elsewhere.empty()) problem += ", it belongs to " + listed(elsewhere);
    throw InputError(entry.place, problem, "one of " + listed(known),
                     nearest_name(entry.key, known));
  }
}

Place TomlSection::place_of(std::string_view key) const {
  Place place = table_.place;
  if (!place.key.empty()) place.key += '.';
  place.key += key;
  return place;
}

Value& TomlSection::get(std::string_view key) {
  if (Value* value = table_.find(key)) return *value;
  const KeyDescription* d = description(key);
  if (d == nullptr) throw InternalError("no key " + std::string(key) + " in section " + name_);
  if (d->fallback.empty()) {
    throw InputError(place_of(key), "the key '" + std::string(key) + "' is missing",
                     std::string(d->type));
  }
  return fill(std::string(key), parse_value(std::string(d->fallback), place_of(key)));
}

Value& TomlSection::fill(const std::string& key, Value fallback) {
  if (Value* value = table_.find(key)) return *value;
  return table_.set(key, std::move(fallback));
}

void TomlSection::exclude(std::string_view one, std::string_view other) const {
  const Value* second = table_.find(other);
  if (table_.find(one) == nullptr || second == nullptr) return;
  throw InputError(second->place,
                   "'" + std::string(one) + "' and '" + std::string(other) + "' are both given",
                   "one of them");
}

std::string read_kind(Value& table, const std::string& section, const std::string& key,
                      const std::vector<std::string>& kinds) {
  TomlSection reader(table, section);
  const Value& value = reader.get(key);
  const std::string kind = as_text(value);
  if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end()) {
    throw InputError(value.place, "unknown " + key + " '" + kind + "'", "one of " + listed(kinds),
                     nearest_name(kind, kinds));
  }
  return kind;
}

}  // namespace carom::files
