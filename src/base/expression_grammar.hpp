// The one grammar of what is typed as a number ("sqrt(3)/2") or as a formula ("x^2 + sin(y)"), by
// recursive descent:
//   sum     = product { ("+" | "-") product }
//   product = signed { ("*" | "/") signed }
//   signed  = { "+" | "-" } power
//   power   = primary [ "^" signed ]          so -2^2 = -4, 2^-3 = 1/8 and 2^3^2 = 2^9
//   primary = decimal | name | name "(" sum [ "," sum ] ")" | "(" sum ")"
//   decimal = digits [ "." digits ] [ ("e" | "E") [ "+" | "-" ] digits ]
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "carom/base/error.hpp"
#include "shown_character.hpp"

namespace carom::base {

/// Why an operation or a word has no value; the grammar adds the place.
struct Fault {
  std::string problem, expected = {}, nearest = {};
};

/// What messages call things, and where the two dialects differ.
struct Dialect {
  std::string_view subject;          ///< "number"
  std::string_view operand;          ///< what may begin one: "a number, pi, sqrt(...) or '('"
  std::string_view product;          ///< expected between two operands
  std::string_view unclosed_before;  ///< before "')' for the one opened …" where the text ends
  std::string_view blanks;
  bool e_is_a_name;     ///< 2e lacks an operator, not the digits of an exponent
  bool column_in_file;  ///< the place is that of the first character, so that faults have their own
};

/// `Meaning` gives values to what is read and throws Fault where there is none:
///   Value, dialect, empty (what is expected instead of nothing),
///   operate('+' | '-' | '*' | '/', a, b), negative(a), check_exponent(b), power(a, b),
///   decimal(text), named(word, is it called?), call(word, arguments),
///   arguments_of(word): of a function, else 0.
template <class Meaning>
class Grammar {
 public:
  using Value = typename Meaning::Value;

  Grammar(std::string_view text, const Place& place, Meaning& meaning)
      : text_(text), place_(place), meaning_(meaning) {}

  Value parse() {
    // Sizes that no honest text needs; beyond them time, memory or the stack would be at the
    // writer's mercy.
    constexpr std::size_t most_characters = 4096;
    const std::string subject = "the " + std::string(dialect.subject);
    if (text_.size() > most_characters)
      throw InputError(place_, subject + " is too long",
                       "at most " + std::to_string(most_characters) + " characters");
    skip_blanks();
    if (at_end()) throw InputError(place_, subject + " is empty", meaning_.empty());
    const Value result = sum();
    if (!at_end()) {
      if (peek() == ')') fail(at_, "')' without '('");
      fail_after_operand("the end");
    }
    return result;
  }

 private:
  static constexpr const Dialect& dialect = Meaning::dialect;
  static constexpr int most_depth = 200;

  static bool is_digit(char c) { return c >= '0' && c <= '9'; }
  static bool is_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
  }

  bool at_end() const { return at_ == text_.size(); }
  char at(std::size_t i) const { return i < text_.size() ? text_[i] : '\0'; }
  char peek() const { return at(at_); }
  void skip_blanks() {
    while (!at_end() && dialect.blanks.find(peek()) != std::string_view::npos) ++at_;
  }
  bool take(char c) {
    if (at_end() || peek() != c) return false;
    ++at_;
    skip_blanks();
    return true;
  }

  // Characters are code points, counted from 1.
  std::size_t character(std::size_t at) const {
    return 1 + at -
           static_cast<std::size_t>(
               std::count_if(text_.begin(), text_.begin() + at, continues_character));
  }

  // Where the character is in the file, if the file is known.
  Place place_of(std::size_t at) const {
    Place place = place_;
    if (!dialect.column_in_file || place.line == 0 || place.column == 0) return place;
    const std::string_view before = text_.substr(0, at);
    const std::size_t last_line = before.rfind('\n');
    if (last_line == std::string_view::npos) {
      place.column += static_cast<int>(at);
    } else {
      place.line += static_cast<int>(std::count(before.begin(), before.end(), '\n'));
      place.column = static_cast<int>(at - last_line);
    }
    return place;
  }

  [[noreturn]] void fail(std::size_t at, const std::string& problem,
                         const std::string& expected = {}, const std::string& nearest = {}) const {
    throw InputError(place_of(at), at_character(problem, character(at), text_), expected, nearest);
  }
  [[noreturn]] void fail_here(const std::string& expected) const {
    fail(at_,
         at_end() ? "the " + std::string(dialect.subject) + " ends too early"
                  : "unexpected " + shown_character(text_, at_),
         expected);
  }
  // Something is where an operator or `else_expected` should be.
  [[noreturn]] void fail_after_operand(const std::string& else_expected) const {
    const bool operand = is_letter(peek()) || is_digit(peek()) || peek() == '(' || peek() == '.';
    fail_here(std::string(operand ? dialect.product : "an operator (+ - * / ^)") + " or " +
              else_expected);
  }
  void close(std::size_t open) {
    if (take(')')) return;
    const std::string closing =
        "')' for the one opened at character " + std::to_string(character(open));
    if (at_end()) fail_here(std::string(dialect.unclosed_before) + closing);
    fail_after_operand(closing);
  }

  // A step of the meaning; `at` is the character to blame.
  auto checked(std::size_t at, auto step) const {
    try {
      return step();
    } catch (const Fault& fault) {
      fail(at, fault.problem, fault.expected, fault.nearest);
    }
  }

  Value sum() {
    Value left = product();
    while (peek() == '+' || peek() == '-') {
      const std::size_t at = at_;
      take(peek());
      const Value right = product();
      left = checked(at, [&] { return meaning_.operate(text_[at], left, right); });
    }
    return left;
  }

  Value product() {
    Value left = signed_power();
    while (peek() == '*' || peek() == '/') {
      const std::size_t at = at_;
      if (text_.substr(at, 2) == "**") fail(at, "unexpected '**'", "'^' for a power");
      take(peek());
      const Value right = signed_power();
      left = checked(at, [&] { return meaning_.operate(text_[at], left, right); });
    }
    return left;
  }

  Value signed_power() {
    const std::size_t at = at_;
    bool negative = false;
    while (peek() == '+' || peek() == '-') {
      negative = negative != (peek() == '-');
      take(peek());
    }
    const Value value = power();
    return negative ? checked(at, [&] { return meaning_.negative(value); }) : value;
  }

  Value power() {
    const Value value = primary();
    const std::size_t at = at_;
    if (!take('^')) return value;
    const std::size_t exponent_at = at_;
    descend(at);
    const Value exponent = signed_power();
    --depth_;
    checked(exponent_at, [&] { return meaning_.check_exponent(exponent); });
    return checked(at, [&] { return meaning_.power(value, exponent); });
  }

  Value primary() {
    const std::size_t start = at_;
    if (take('(')) {
      const Value value = inside(start);
      close(start);
      return value;
    }
    if (is_digit(peek()) || (peek() == '.' && is_digit(at(at_ + 1)))) return decimal();
    if (!is_letter(peek())) fail_here(std::string(dialect.operand));
    while (is_letter(peek()) || is_digit(peek())) ++at_;
    const std::string word(text_.substr(start, at_ - start));
    skip_blanks();
    if (const int arguments = meaning_.arguments_of(word)) return call(word, arguments, start);
    const Value value = checked(start, [&] { return meaning_.named(word, peek() == '('); });
    if (peek() == '(') fail(at_, "'" + word + "' is no function", "an operator (* for a product)");
    return value;
  }

  Value call(const std::string& word, int wanted, std::size_t start) {
    const std::string takes =
        word + (wanted == 1 ? " takes one argument" : " takes two arguments, separated by ','");
    const std::size_t open = at_;
    if (!take('(')) fail_here("'(' after " + word);
    if (peek() == ')') fail_here("an argument: " + takes);
    std::vector<Value> arguments{inside(open)};
    if (wanted == 2) {
      if (peek() == ')') fail_here("',': " + takes);
      if (!take(',')) fail_after_operand("','");
      arguments.push_back(inside(open));
    }
    if (peek() == ',') fail_here("')': " + takes);
    close(open);
    return checked(start, [&] { return meaning_.call(word, arguments); });
  }

  // What is inside a parenthesis that was opened at `open`.
  Value inside(std::size_t open) {
    descend(open);
    const Value value = sum();
    --depth_;
    return value;
  }
  void descend(std::size_t at) {
    if (++depth_ > most_depth)
      fail(at, "nested too deeply", "at most " + std::to_string(most_depth) + " levels");
  }

  // One underscore may stand between two digits, as in TOML.
  void skip_digits() {
    while (is_digit(peek()) || (peek() == '_' && is_digit(at(at_ + 1)) && is_digit(at(at_ - 1))))
      ++at_;
  }

  Value decimal() {
    const std::size_t start = at_;
    skip_digits();
    if (peek() == '.') ++at_;
    skip_digits();
    const bool has_sign = at(at_ + 1) == '+' || at(at_ + 1) == '-';
    const std::size_t digits = at_ + (has_sign ? 2 : 1);
    if ((peek() == 'e' || peek() == 'E') && (is_digit(at(digits)) || !dialect.e_is_a_name)) {
      at_ = digits;
      if (!is_digit(peek())) fail_here("the digits of the exponent");
      skip_digits();
    }
    const std::string_view written = text_.substr(start, at_ - start);
    skip_blanks();
    return checked(start, [&] { return meaning_.decimal(written); });
  }

  std::string_view text_;
  const Place& place_;
  Meaning& meaning_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace carom::base
