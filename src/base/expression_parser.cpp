// Recursive descent over the grammar
//   sum     = product { ("+" | "-") product }
//   product = signed { ("*" | "/") signed }
//   signed  = { "+" | "-" } power
//   power   = primary [ "^" signed ]          so -2^2 = -4, 2^-3 = 1/8 and 2^3^2 = 2^9
//   primary = decimal | "pi" | "sqrt" "(" sum ")" | "(" sum ")"
#include <algorithm>
#include <cstdlib>
#include <string>
#include <utility>

#include "expression.hpp"
#include "shown_character.hpp"

namespace carom::base::expression {
namespace {

// Sizes no honest number needs; beyond them time, memory or the stack would be at the writer's
// mercy.
constexpr std::size_t most_characters = 4096;
constexpr int most_depth = 200;
constexpr long most_decimal_exponent = 5000;
constexpr long most_exponent = 10000;

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

class Parser {
 public:
  Parser(std::string_view text, const Place& place) : text_(text), place_(place) {}

  NodePointer parse() {
    if (text_.size() > most_characters) {
      throw InputError(place_, "the number is too long",
                       "at most " + std::to_string(most_characters) + " characters");
    }
    skip_blanks();
    if (at_end())
      throw InputError(place_, "the number is empty", "a number such as 0.5, 1/3 or sqrt(3)/2");
    NodePointer result = parse_sum();
    if (!at_end()) {
      if (peek() == ')') fail(at_, "')' without '('");
      fail(at_, "unexpected " + shown(at_), "an operator (+ - * / ^) or the end");
    }
    return result;
  }

 private:
  bool at_end() const { return at_ == text_.size(); }
  char peek() const { return at_end() ? '\0' : text_[at_]; }
  void skip_blanks() {
    while (!at_end() && (peek() == ' ' || peek() == '\t')) ++at_;
  }
  bool take(char c) {
    if (at_end() || peek() != c) return false;
    ++at_;
    skip_blanks();
    return true;
  }

  std::string shown(std::size_t at) const {
    return at < text_.size() ? shown_character(text_, at) : "end";
  }

  // Characters are code points, counted from 1.
  std::size_t character(std::size_t at) const {
    std::size_t count = 1;
    for (std::size_t i = 0; i < at; ++i) {
      if (!continues_character(text_[i])) ++count;
    }
    return count;
  }

  [[noreturn]] void fail(std::size_t at, const std::string& problem,
                         const std::string& expected = {}, const std::string& nearest = {}) const {
    throw InputError(place_, at_character(problem, character(at), text_), expected, nearest);
  }

  // An operation that may have no value; `at` is the character to blame.
  template <class Operation>
  NodePointer evaluate(std::size_t at, Operation operation) const {
    try {
      return operation();
    } catch (const NoValue& reason) {
      fail(at, reason.what());
    }
  }

  NodePointer parse_sum() {
    NodePointer left = parse_product();
    while (!at_end() && (peek() == '+' || peek() == '-')) {
      const std::size_t at = at_;
      const bool plus = peek() == '+';
      take(peek());
      const NodePointer right = parse_product();
      left = evaluate(at, [&] { return plus ? sum(left, right) : difference(left, right); });
    }
    return left;
  }

  NodePointer parse_product() {
    NodePointer left = parse_signed();
    while (!at_end() && (peek() == '*' || peek() == '/')) {
      const std::size_t at = at_;
      const bool times = peek() == '*';
      take(peek());
      const NodePointer right = parse_signed();
      left = evaluate(at, [&] { return times ? product(left, right) : quotient(left, right); });
    }
    return left;
  }

  NodePointer parse_signed() {
    const std::size_t at = at_;
    bool negative = false;
    while (!at_end() && (peek() == '+' || peek() == '-')) {
      negative = negative != (peek() == '-');
      take(peek());
    }
    const NodePointer value = parse_power();
    return negative ? evaluate(at, [&] { return difference(leaf({}), value); }) : value;
  }

  NodePointer parse_power() {
    const NodePointer value = parse_primary();
    const std::size_t at = at_;
    if (!take('^')) return value;
    const std::size_t exponent_at = at_;
    descend(at);
    const NodePointer exponent = parse_signed();
    --depth_;
    const ClosedForm& n = exponent->closed;
    if (exponent->operation != Node::Operation::leaf || !n.is_rational() ||
        n.coefficient.get_den() != 1) {
      fail(exponent_at, "the exponent is not an integer",
           "an integer; sqrt(...) for a square root");
    }
    if (abs(n.coefficient) > most_exponent) {
      fail(exponent_at, "the exponent is too large",
           "at most " + std::to_string(most_exponent) + " in size");
    }
    return evaluate(at, [&] { return power(value, n.coefficient.get_num().get_si()); });
  }

  NodePointer parse_primary() {
    const std::size_t at = at_;
    if (at_end()) fail(at_, "the number ends too early", "a number, pi, sqrt(...) or '('");
    if (take('(')) return parse_group(at);
    if (is_digit(peek()) || peek() == '.') return parse_decimal();
    if (!is_letter(peek())) {
      fail(at_, "unexpected " + shown(at_), "a number, pi, sqrt(...) or '('");
    }
    const std::string word = take_word();
    skip_blanks();
    if (word == "pi") return leaf({1, 1, 1});
    if (word == "sqrt") {
      if (!take('(')) fail(at_, "unexpected " + shown(at_), "'(' after sqrt");
      const NodePointer radicand = parse_group(at);
      return evaluate(at, [&] { return root(radicand); });
    }
    if (const std::string w = lowered(word); w == "nan" || w == "inf" || w == "infinity") {
      fail(at, "'" + word + "' is not a finite number");
    }
    fail(at, "unknown word '" + word + "'", "a number, pi or sqrt(...)",
         nearest_name(word, {"pi", "sqrt"}));
  }

  // What follows an opening parenthesis that stands at `open`.
  NodePointer parse_group(std::size_t open) {
    descend(open);
    const NodePointer inside = parse_sum();
    --depth_;
    if (at_end())
      fail(at_, "the number ends too early",
           "')' for the one opened at character " + std::to_string(character(open)));
    if (!take(')')) fail(at_, "unexpected " + shown(at_), "an operator (+ - * / ^) or ')'");
    return inside;
  }

  void descend(std::size_t at) {
    if (++depth_ > most_depth)
      fail(at, "nested too deeply", "at most " + std::to_string(most_depth) + " levels");
  }

  std::string take_word() {
    const std::size_t start = at_;
    while (!at_end() && (is_letter(peek()) || is_digit(peek()) || peek() == '_')) ++at_;
    return std::string(text_.substr(start, at_ - start));
  }

  static std::string lowered(std::string word) {
    for (char& c : word) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return word;
  }

  // A run of digits, where one underscore may stand between two of them, as in TOML.
  std::string take_digits() {
    std::string found;
    while (!at_end()) {
      if (is_digit(peek())) {
        found += text_[at_++];
      } else if (peek() == '_' && !found.empty() && is_digit(text_[at_ - 1]) &&
                 at_ + 1 < text_.size() && is_digit(text_[at_ + 1])) {
        ++at_;
      } else {
        break;
      }
    }
    return found;
  }

  NodePointer parse_decimal() {
    const std::size_t start = at_;
    std::string mantissa = take_digits();
    long exponent = 0;
    if (peek() == '.') {
      ++at_;
      const std::string fraction = take_digits();
      if (mantissa.empty() && fraction.empty()) fail(at_, "unexpected " + shown(at_), "a digit");
      mantissa += fraction;
      exponent = -static_cast<long>(fraction.size());
    }
    if (peek() == 'e' || peek() == 'E') exponent += take_exponent(start);
    skip_blanks();
    mpz_class power_of_ten;
    mpz_ui_pow_ui(power_of_ten.get_mpz_t(), 10, static_cast<unsigned long>(std::labs(exponent)));
    const mpz_class digits(mantissa, 10);
    mpq_class value =
        exponent < 0 ? mpq_class(digits, power_of_ten) : mpq_class(digits * power_of_ten);
    value.canonicalize();
    return evaluate(start, [&] { return leaf({value, 1, 0}); });
  }

  long take_exponent(std::size_t start) {
    ++at_;
    const bool negative = peek() == '-';
    if (peek() == '-' || peek() == '+') ++at_;
    const std::size_t at = at_;
    const std::string found = take_digits();
    if (found.empty()) fail(at, "unexpected " + shown(at), "the digits of the exponent");
    long exponent = 0;
    for (const char c : found) {
      exponent = 10 * exponent + (c - '0');
      if (exponent > most_decimal_exponent) {
        fail(start, "the exponent of ten is too large",
             "at most " + std::to_string(most_decimal_exponent) + " in size");
      }
    }
    return negative ? -exponent : exponent;
  }

  std::string_view text_;
  const Place& place_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

NodePointer parse(std::string_view text, const Place& place) { return Parser(text, place).parse(); }

}  // namespace carom::base::expression
