#include "program.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace carom {

namespace fs = std::filesystem;

namespace {

// The first checkpoint of a run anew holds nothing. Signal 15 is bit 14 of those that are caught.
const char* const functions = R"sh(
until_there() { until [ -s "$1" ]; do kill -0 $pid 2>/dev/null || return 1; sleep 0.01; done; }
until_saved() {
  checkpoint="$1.part/checkpoint.h5"
  until_there "$checkpoint" || return 1
  found=$(stat -c %y "$checkpoint")
  while [ "$(stat -c %y "$checkpoint" 2>/dev/null)" = "$found" ]; do kill -0 $pid 2>/dev/null || return 1; sleep 0.01; done
}
children_of() { cat /proc/$1/task/*/children | tr ' ' '\n' | sed '/^$/d' | sort -n; }
until_listening() {
  until grep -qs '^SigCgt:.*[4-7c-f]...$' /proc/$pid/status; do kill -0 $pid 2>/dev/null || return 1; sleep 0.01; done
  $listens_late
}
)sh";

// An emulator handles signals from its start on, so that nothing tells when the program does.
constexpr const char* listens_late =
    CAROM_EMULATED ? "listens_late='sleep 5'; " : "listens_late=; ";

}  // namespace

Outcome Shell::operator()(const std::string& command) const {
  const std::string script = listens_late + std::string(functions) + "cd '" + folder() +
                             "'; carom='" CAROM_PROGRAM "'; {\n" + command +
                             "\n} >.out 2>.err </dev/null";
  const int raw = std::system(script.c_str());
  Outcome outcome;
  outcome.status = WIFEXITED(raw) ? WEXITSTATUS(raw) : 128 + WTERMSIG(raw);
  outcome.out = read(".out");
  outcome.err = read(".err");
  return outcome;
}

bool Shell::exists(const std::string& file) const { return fs::exists(folder_.path() / file); }

std::string Shell::read(const std::string& file) const {
  std::ifstream in(folder_.path() / file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::vector<std::string> Shell::files() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder_.path())) {
    const std::string name = entry.path().filename().string();
    if (name != ".out" && name != ".err") names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

namespace {

// A recogniser of JSON (RFC 8259).
class Reader {
 public:
  explicit Reader(const std::string& text) : text_(text) {}
  bool object() {
    blank();
    if (peek() != '{' || !value()) return false;
    blank();
    return at_ == text_.size();
  }

 private:
  char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  bool take(char c) {
    blank();
    if (peek() != c) return false;
    ++at_;
    return true;
  }
  void blank() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
  }
  bool word(const std::string& w) {
    if (text_.compare(at_, w.size(), w) != 0) return false;
    at_ += w.size();
    return true;
  }
  bool string() {
    if (!take('"')) return false;
    while (peek() != '"') {
      if (static_cast<unsigned char>(peek()) < 0x20) return false;
      at_ += peek() == '\\' ? 2 : 1;
    }
    ++at_;
    return true;
  }
  bool digits() {
    const std::size_t start = at_;
    while (std::isdigit(static_cast<unsigned char>(peek()))) ++at_;
    return at_ > start;
  }
  bool number() {
    if (peek() == '-') ++at_;
    if (!digits()) return false;
    if (peek() == '.' && (++at_, !digits())) return false;
    if (peek() == 'e' || peek() == 'E') {
      ++at_;
      if (peek() == '+' || peek() == '-') ++at_;
      return digits();
    }
    return true;
  }
  bool members(char end, bool keys) {
    if (take(end)) return true;
    do {
      if (keys && !(string() && take(':'))) return false;
      if (!value()) return false;
    } while (take(','));
    return take(end);
  }
  bool value() {
    blank();
    switch (peek()) {
      case '{':
        ++at_;
        return members('}', true);
      case '[':
        ++at_;
        return members(']', false);
      case '"':
        return string();
      case 't':
        return word("true");
      case 'f':
        return word("false");
      case 'n':
        return word("null");
      default:
        return number();
    }
  }
  const std::string& text_;
  std::size_t at_ = 0;
};

}  // namespace

void expect_refused(const Outcome& outcome, const std::string& place) {
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_TRUE(outcome.err.starts_with("carom: " + place)) << outcome.err;
}

std::string on_one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

bool is_json_object(const std::string& text) { return Reader(text).object(); }

std::string json_value(const std::string& text, const std::string& key) {
  const std::string mark = "\n  \"" + key + "\": ";
  const std::size_t start = text.find(mark);
  if (start == std::string::npos) return "";
  const std::size_t from = start + mark.size();
  const bool lines = text.compare(from, 2, "[\n") == 0;
  const std::size_t end = lines ? text.find("\n  ]", from) + 4 : text.find('\n', from);
  std::string value = text.substr(from, end - from);
  if (!value.empty() && value.back() == ',') value.pop_back();
  return value;
}

}  // namespace carom
