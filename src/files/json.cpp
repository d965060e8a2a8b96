#include "files/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/printable.hpp"
#include "carom/base/decimal.hpp"

namespace carom::files {

namespace {

std::string quoted(std::string_view text) {
  std::string out = "\"";
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char c = text[at];
    const base::CodePoint point = base::code_point(text, at);
    if (point.bytes != 1) {  // JSON is UTF-8: other bytes are shown as text
      const std::string_view whole = text.substr(at, std::max<std::size_t>(point.bytes, 1));
      const std::string shown = base::printable(whole);
      out += point.bytes == 0 || shown.starts_with("\\U") ? "\\" + shown : shown;
      at += whole.size() - 1;
      continue;
    }
    switch (c) {
      case '"':
        out += "\\\"";
        break;
      case '\\':
        out += "\\\\";
        break;
      case '\n':
        out += "\\n";
        break;
      case '\t':
        out += "\\t";
        break;
      case '\r':
        out += "\\r";
        break;
      default:
        if (base::acts(static_cast<unsigned char>(c)))
          out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
        else
          out += c;
    }
  }
  return out + '"';
}

}  // namespace

Json::Json(double value) {
  if (std::isnan(value)) return;
  text_ = fmt::format("{}", value);
  if (std::isinf(value)) text_ = quoted(text_);
}

Json::Json(std::string_view value) : text_(quoted(value)) {}

void Json::set_integer(bool negative, std::uint64_t size) {
  text_ = fmt::format("{}{}", negative ? "-" : "", size);
  if (size > (std::uint64_t{1} << 53)) text_ = quoted(text_);
}

Json& Json::set(std::string_view key, Json value) {
  members_.emplace_back(key, std::move(value));
  return *this;
}

Json& Json::add(const Json& object) {
  members_.insert(members_.end(), object.members_.begin(), object.members_.end());
  return *this;
}

Json& Json::push(Json value) {
  members_.emplace_back(std::string(), std::move(value));
  return *this;
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

bool Json::holds_objects() const {
  return kind_ == Kind::array && !members_.empty() && members_.front().second.kind_ == Kind::object;
}

std::string Json::text() const {
  std::string out;
  print(out, 0);
  return out;
}

void Json::print(std::string& out, int depth) const {
  if (kind_ == Kind::scalar) {
    out += text_;
    return;
  }
  const bool object = kind_ == Kind::object;
  const bool lines = !members_.empty() && depth < 2 && ((object && depth == 0) || holds_objects());
  const std::string indent =
      lines ? '\n' + std::string(2 * static_cast<std::size_t>(depth) + 2, ' ') : "";
  out += object ? '{' : '[';
  for (std::size_t i = 0; i < members_.size(); ++i) {
    if (i > 0) out += lines ? "," : ", ";
    out += indent;
    if (object) out += quoted(members_[i].first) + ": ";
    members_[i].second.print(out, depth + 1);
  }
  if (lines) out += '\n' + std::string(2 * static_cast<std::size_t>(depth), ' ');
  out += object ? '}' : ']';
}

}  // namespace carom::files
