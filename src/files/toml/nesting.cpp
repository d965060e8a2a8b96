#include "files/toml/nesting.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include "base/shown_character.hpp"

namespace carom::files {
namespace {

struct Fault {
  std::size_t at;  ///< byte of the text
  std::string problem, expected;
};

// Reads just enough of TOML to tell keys, values, strings and comments apart. What is no TOML may
// pass: the parser refuses it later, and needs no more levels than are counted here.
class Scan {
 public:
  explicit Scan(std::string_view text) : text_(text) {}

  /// `in_value`: the text begins with a value, not with a key.
  std::optional<Fault> run(bool in_value) {
    in_value_ = in_value;
    for (at_ = 0; at_ < text_.size(); ++at_) {
      step(text_[at_]);
      if (header_ + levels_ + dots_ > most_levels)
        return Fault{at_, "nested too deeply",
                     "at most " + std::to_string(most_levels) + " levels"};
      if (values_ > most_values)
        return Fault{at_, "too many values", "at most " + std::to_string(most_values)};
    }
    return {};
  }

 private:
  struct Open {
    bool table;
    std::size_t dots;  ///< of the key before it
  };

  void step(char c) {
    const bool first = at_line_start_;
    if (c != ' ' && c != '\t') at_line_start_ = false;
    switch (c) {
      case '"':
      case '\'':
        return skip_string(c);
      case '#':
        at_ = std::min(text_.find('\n', at_), text_.size()) - 1;
        return;
      case '\n':
        at_line_start_ = true;
        if (open_.empty()) {
          in_header_ = in_value_ = false;
          dots_ = 0;
        }
        return;
      case '.':
        if (in_header_)
          ++header_;
        else if (!in_value_)
          ++dots_;
        return;
      case '=':
        in_value_ = true;
        return;
      case '[':
        if (open_.empty() && !in_value_) {
          header_ = first ? 1 : header_ + 1;  // [a] or [[a]]
          in_header_ = true;
          return;
        }
        return open(false);
      case '{':
        return open(true);
      case ']':
      case '}':
        return close();
      case ',':
        ++values_;
        if (open_.empty()) return;
        in_value_ = !open_.back().table;
        dots_ = 0;
        return;
      default:
        return;
    }
  }

  void open(bool table) {
    ++values_;
    open_.push_back({table, dots_});
    levels_ += dots_ + 1;
    dots_ = 0;
    in_value_ = !table;
  }

  void close() {
    if (open_.empty()) return;
    levels_ -= open_.back().dots + 1;
    open_.pop_back();
    dots_ = 0;
    in_value_ = true;
  }

  // "…", '…', """…""", '''…'''; one line except for the last two. Ends at its last character.
  void skip_string(char quote) {
    const std::string three(3, quote);
    const bool lines = text_.substr(at_, 3) == three;
    at_ += lines ? 3 : 1;
    for (; at_ < text_.size(); ++at_) {
      if (quote == '"' && text_[at_] == '\\') {
        ++at_;
      } else if (lines ? text_.substr(at_, 3) == three : text_[at_] == quote) {
        at_ += lines ? 2 : 0;
        while (lines && at_ + 1 < text_.size() && text_[at_ + 1] == quote) ++at_;
        return;
      } else if (!lines && text_[at_] == '\n') {
        --at_;
        return;
      }
    }
  }

  std::string_view text_;
  std::size_t at_ = 0;
  bool at_line_start_ = true, in_header_ = false, in_value_ = false;
  std::size_t header_ = 0, levels_ = 0, dots_ = 0, values_ = 0;
  std::vector<Open> open_;
};

Place place_of(std::string_view text, std::size_t at, const std::string& file) {
  text = text.substr(0, at);
  const std::size_t end = text.rfind('\n');
  const std::string_view line = end == std::string_view::npos ? text : text.substr(end + 1);
  const auto inner = std::count_if(line.begin(), line.end(), base::continues_character);
  const std::size_t mark = line.substr(0, 3) == "\xEF\xBB\xBF" && end == std::string_view::npos;
  return {file, 1 + static_cast<int>(std::count(text.begin(), text.end(), '\n')),
          1 + static_cast<int>(line.size() - mark) - static_cast<int>(inner), ""};
}

}  // namespace

void check_nesting(std::string_view toml, const std::string& file) {
  if (const auto fault = Scan(toml).run(false))
    throw InputError(place_of(toml, fault->at, file), fault->problem, fault->expected);
}

void check_nesting_of_value(std::string_view value, const Place& place) {
  if (const auto fault = Scan(value).run(true))
    throw InputError(place, fault->problem, fault->expected);
}

}  // namespace carom::files
