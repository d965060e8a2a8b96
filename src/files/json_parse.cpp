// JSON that this program wrote, read back.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>

#include "carom/base/decimal.hpp"
#include "carom/base/error.hpp"
#include "files/json.hpp"

namespace carom::files {

class Json::Parser {
 public:
  Parser(std::string_view text, const std::string& name) : text_(text), name_(name) {}
  Json whole() {
    Json value = any(0);
    blanks();
    if (at_ != text_.size()) fail();
    return value;
  }

 private:
  // Results nest a few deep. A damaged text must not exhaust the stack.
  static constexpr int deepest = 100;

  [[noreturn]] void fail() const {
    throw InputError(Place{name_, 0, 0, ""}, fmt::format("no JSON at character {}", at_ + 1),
                     "a report as carom wrote it");
  }
  void blanks() { at_ = std::min(text_.find_first_not_of(" \n\t\r", at_), text_.size()); }
  char next() {
    blanks();
    return at_ < text_.size() ? text_[at_] : '\0';
  }
  void expect(char c) {
    if (next() != c) fail();
    ++at_;
  }
  Json any(int depth) {
    if (depth > deepest) fail();
    const char first = next();
    if (first == '{' || first == '[') return members(first == '{', depth);
    Json scalar;
    scalar.text_ = first == '"' ? quoted_text() : word();
    return scalar;
  }
  Json members(bool object, int depth) {
    Json made = object ? Json::object() : Json::array();
    const char close = object ? '}' : ']';
    ++at_;
    for (bool first = true; next() != close; first = false) {
      if (!first) expect(',');
      std::string key;
      if (object) {
        if (next() != '"') fail();
        Json name;
        name.text_ = quoted_text();
        key = *name.string();
        expect(':');
      }
      made.members_.emplace_back(key, any(depth + 1));
    }
    ++at_;
    return made;
  }
  std::string quoted_text() {
    const std::size_t begin = at_++;
    while (at_ < text_.size() && text_[at_] != '"') at_ += text_[at_] == '\\' ? 2 : 1;
    if (at_ >= text_.size()) fail();
    ++at_;
    return std::string(text_.substr(begin, at_ - begin));
  }
  std::string word() {
    const std::size_t begin = at_;
    at_ = std::min(text_.find_first_of(",]} \n\t\r", at_), text_.size());
    const std::string_view found = text_.substr(begin, at_ - begin);
    if (!nearest_double(found) && found != "true" && found != "false" && found != "null") fail();
    return std::string(found);
  }

  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0;
};

Json Json::parse(std::string_view text, const std::string& name) {
  return Parser(text, name).whole();
}

const Json* Json::find(std::string_view path) const {
  if (kind_ == Kind::scalar) return nullptr;
  if (kind_ == Kind::object)
    for (const auto& [key, value] : members_)
      if (key == path) return &value;  // keys may hold points themselves: "field.B"
  const std::size_t point = std::min(path.find('.'), path.size());
  const std::string_view first = path.substr(0, point);
  const Json* found = nullptr;
  if (kind_ == Kind::array) {
    std::int64_t index = 0;
    const auto [end, error] = std::from_chars(first.data(), first.data() + first.size(), index);
    if (error != std::errc{} || end != first.data() + first.size()) return nullptr;
    const auto size = static_cast<std::int64_t>(members_.size());
    if (index < 0) index += size;
    if (index < 0 || index >= size) return nullptr;
    found = &members_[static_cast<std::size_t>(index)].second;
  } else {
    for (const auto& [key, value] : members_)
      if (key == first) found = &value;
  }
  return !found || point == path.size() ? found : found->find(path.substr(point + 1));
}

std::optional<std::string> Json::string() const {
  if (kind_ != Kind::scalar || text_.front() != '"') return {};
  std::string out;
  for (std::size_t i = 1; i + 1 < text_.size(); ++i) {
    if (text_[i] != '\\') {
      out += text_[i];
      continue;
    }
    const char c = text_[++i];
    if (c == 'u') {  // control characters, the only ones that are written so
      unsigned code = 0;
      std::from_chars(text_.data() + i + 1, text_.data() + std::min(i + 5, text_.size()), code, 16);
      out += static_cast<char>(code);
      i += 4;
    } else {
      out += c == 'n' ? '\n' : c == 't' ? '\t' : c == 'r' ? '\r' : c;
    }
  }
  return out;
}

std::optional<double> Json::number() const {
  if (kind_ != Kind::scalar) return {};
  return nearest_double(string().value_or(text_));
}

}  // namespace carom::files
