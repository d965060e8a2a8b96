#include "files/toml/value.hpp"

#include <algorithm>
#include <utility>

#include "base/name_among.hpp"

namespace carom::files {
namespace {

std::string quoted(const std::string& text) {
  static constexpr char digits[] = "0123456789abcdef";
  std::string result = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      result += '\\';
      result += c;
    } else if (byte < 0x20 || byte == 0x7f) {
      result += "\\u00";
      result += digits[byte >> 4];
      result += digits[byte & 15];
    } else {
      result += c;
    }
  }
  return result + "\"";
}

std::string printed_key(const std::string& key) {
  const bool bare = !key.empty() && std::all_of(key.begin(), key.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-';
  });
  return bare ? key : quoted(key);
}

std::string printed(const Value& value) {
  std::string result;
  switch (value.kind) {
    case Value::Kind::number:
      return value.text;
    case Value::Kind::boolean:
      return value.flag ? "true" : "false";
    case Value::Kind::list:
      for (const Value& item : value.items) result += (result.empty() ? "" : ", ") + printed(item);
      return "[" + result + "]";
    case Value::Kind::table:
      for (const Entry& entry : value.entries) {
        result +=
            (result.empty() ? "" : ", ") + printed_key(entry.key) + " = " + printed(entry.value);
      }
      return "{" + result + "}";
    case Value::Kind::text:
    case Value::Kind::other:
      break;
  }
  return quoted(value.text);
}

// [[table.hole]], [[table.wall]], [[table.region]] and [[table.loop]] have headers of their own.
bool has_headers(const std::string& section, const Entry& entry) {
  return section == "table" &&
         (entry.key == "hole" || entry.key == "wall" || entry.key == "region" ||
          entry.key == "loop") &&
         entry.value.kind == Value::Kind::list && !entry.value.items.empty() &&
         std::all_of(entry.value.items.begin(), entry.value.items.end(),
                     [](const Value& v) { return v.kind == Value::Kind::table; });
}

void print_section(const std::string& name, const Value& section, std::string& out) {
  for (const Entry& entry : section.entries) {
    if (!has_headers(name, entry))
      out += printed_key(entry.key) + " = " + printed(entry.value) + "\n";
  }
  for (const Entry& entry : section.entries) {
    if (!has_headers(name, entry)) continue;
    for (const Value& item : entry.value.items) {
      out += "\n[[" + name + "." + entry.key + "]]\n";
      print_section(name + "." + entry.key, item, out);
    }
  }
}

}  // namespace

Value* Value::find(std::string_view key) {
  return const_cast<Value*>(static_cast<const Value*>(this)->find(key));
}

const Value* Value::find(std::string_view key) const {
  for (const Entry& entry : entries) {
    if (entry.key == key) return &entry.value;
  }
  return nullptr;
}

Value& Value::set(const std::string& key, Value value) {
  if (Value* old = find(key)) return *old = std::move(value);
  entries.push_back({key, value.place, std::move(value)});
  return entries.back().value;
}

void Value::erase(std::string_view key) {
  std::erase_if(entries, [key](const Entry& entry) { return entry.key == key; });
}

std::string name_of(Value::Kind kind) {
  return base::name_among<Value::Kind::other>(
      {"a number", "a string", "a boolean", "a list", "a table", "a date or time"}, kind);
}

Value empty_value(Value::Kind kind, const Place& place) {
  Value value;
  value.kind = kind;
  value.place = place;
  return value;
}

Value number_value(std::string text, const Place& place) {
  Value value = empty_value(Value::Kind::number, place);
  value.text = std::move(text);
  return value;
}

Value text_value(std::string text, const Place& place) {
  Value value = empty_value(Value::Kind::text, place);
  value.text = std::move(text);
  return value;
}

Value flag_value(bool flag, const Place& place) {
  Value value = empty_value(Value::Kind::boolean, place);
  value.flag = flag;
  return value;
}

std::string print_document(const Value& root) {
  std::string out;
  for (const Entry& entry : root.entries) {
    if (entry.value.kind != Value::Kind::table) {
      out += printed_key(entry.key) + " = " + printed(entry.value) + "\n";
    }
  }
  for (const Entry& entry : root.entries) {
    if (entry.value.kind != Value::Kind::table) continue;
    out += (out.empty() ? "[" : "\n[") + printed_key(entry.key) + "]\n";
    print_section(entry.key, entry.value, out);
  }
  return out;
}

}  // namespace carom::files
