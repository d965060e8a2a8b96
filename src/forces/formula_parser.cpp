// Recursive descent over the grammar of numbers (base/expression_parser.cpp), wider by names,
// functions and exponents of any kind:
//   sum     = product { ("+" | "-") product }
//   product = signed { ("*" | "/") signed }
//   signed  = { "+" | "-" } power
//   power   = primary [ "^" signed ]
//   primary = decimal | name | name "(" sum { "," sum } ")" | "(" sum ")"
// A parser of its own: that one folds exact closed forms as it reads and allows what stays exact;
// this one writes operations on doubles. Decimals are read by ExactNumber.
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/shown_character.hpp"
#include "carom/base/exact_number.hpp"
#include "forces/formula.hpp"

namespace carom::forces::formula {
namespace {

// Sizes no honest formula needs; beyond them time, memory or the stack would be at the writer's
// mercy.
constexpr std::size_t most_characters = 4096;
constexpr int most_depth = 200;

struct Function {
  const char* name;
  Operation operation;
  int arguments;
};
constexpr Function functions[] = {
    {"sqrt", Operation::root, 1},  {"exp", Operation::exp, 1},   {"log", Operation::log, 1},
    {"sin", Operation::sin, 1},    {"cos", Operation::cos, 1},   {"tan", Operation::tan, 1},
    {"sinh", Operation::sinh, 1},  {"cosh", Operation::cosh, 1}, {"tanh", Operation::tanh, 1},
    {"abs", Operation::abs, 1},    {"min", Operation::least, 2}, {"max", Operation::greatest, 2},
    {"atan2", Operation::atan2, 2}};
constexpr std::pair<const char*, double> constants[] = {{"pi", 0x1.921fb54442d18p1},
                                                        {"e", 0x1.5bf0a8b145769p1}};
constexpr const char* operators = "an operator (+ - * / ^)";

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

const Function* function_named(const std::string& word) {
  const auto found = std::find_if(std::begin(functions), std::end(functions),
                                  [&](const Function& f) { return f.name == word; });
  return found == std::end(functions) ? nullptr : found;
}

class Parser {
 public:
  Parser(std::string_view text, std::span<const std::string> variables,
         const std::map<std::string, double>& parameters, const Place& place)
      : text_(text),
        place_(place),
        variables_(variables),
        parameters_(parameters),
        builder_(variables.size()) {}

  Formula parse() {
    check_parameters();
    if (text_.size() > most_characters) {
      throw InputError(place_, "the formula is too long",
                       "at most " + std::to_string(most_characters) + " characters");
    }
    skip_blanks();
    if (at_end())
      throw InputError(place_, "the formula is empty", "a formula in " + joined(names(variables_)));
    const Part result = parse_sum();
    if (!at_end()) {
      if (peek() == ')') fail(at_, "')' without '('");
      fail_after_operand("the end");
    }
    return builder_.finish(result);
  }

 private:
  // A name that means two things would be read as one of them in silence.
  void check_parameters() const {
    for (const auto& [name, value] : parameters_) {
      const bool variable =
          std::find(variables_.begin(), variables_.end(), name) != variables_.end();
      if (variable || is_constant(name) || function_named(name)) {
        throw InputError(place_, "the name of parameter '" + name + "' is taken", "another name");
      }
      const bool typable =
          !name.empty() && is_letter(name.front()) &&
          std::all_of(name.begin(), name.end(), [](char c) { return is_letter(c) || is_digit(c); });
      if (!typable) {
        throw InputError(place_, "a parameter cannot be called '" + name + "'",
                         "letters, digits and '_', a letter first");
      }
      if (!std::isfinite(value))
        throw InputError(place_, "parameter '" + name + "' is not a finite number");
    }
  }
  static bool is_constant(const std::string& word) {
    return std::any_of(std::begin(constants), std::end(constants),
                       [&](const auto& c) { return c.first == word; });
  }
  static std::vector<std::string> names(std::span<const std::string> of) {
    return {of.begin(), of.end()};
  }

  bool at_end() const { return at_ == text_.size(); }
  char peek() const { return at_end() ? '\0' : text_[at_]; }
  bool digit_at(std::size_t at) const { return at < text_.size() && is_digit(text_[at]); }
  void skip_blanks() {
    while (!at_end() && is_blank(peek())) ++at_;
  }
  bool take(char c) {
    if (at_end() || peek() != c) return false;
    ++at_;
    skip_blanks();
    return true;
  }

  std::string shown(std::size_t at) const { return base::shown_character(text_, at); }
  std::string found() const {
    return at_end() ? "the formula ends too early" : "unexpected " + shown(at_);
  }

  // Characters are counted from 1. Bytes serve: the first that is not ASCII is itself to blame.
  static std::size_t character(std::size_t at) { return 1 + at; }

  // Where the character stands in the file, if the file is known.
  Place place_of(std::size_t at) const {
    Place place = place_;
    if (place.line == 0 || place.column == 0) return place;
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
    throw InputError(place_of(at), base::at_character(problem, character(at), text_), expected,
                     nearest);
  }

  // Something stands where an operator or `else_expected` should.
  [[noreturn]] void fail_after_operand(const std::string& else_expected) const {
    const bool operand =
        !at_end() && (is_letter(peek()) || is_digit(peek()) || peek() == '(' || peek() == '.');
    fail(at_, found(),
         std::string(operand ? "an operator (* for a product)" : operators) + " or " +
             else_expected);
  }

  // A part that is a number has to be finite; `at` is the character to blame.
  template <class Operate>
  Part checked(std::size_t at, Operate operate) {
    std::optional<Part> part;
    try {
      part = operate();
    } catch (const TooLong&) {
      fail(at, "the formula has too many operations", "at most " + std::to_string(most_slots));
    }
    if (part->is_number && !std::isfinite(part->number)) {
      fail(at, std::isnan(part->number) ? "this has no value" : "this is not finite");
    }
    return *part;
  }

  Part parse_sum() {
    Part left = parse_product();
    while (peek() == '+' || peek() == '-') {
      const std::size_t at = at_;
      const bool plus = peek() == '+';
      take(peek());
      const Part right = parse_product();
      left = checked(
          at, [&] { return plus ? builder_.sum(left, right) : builder_.difference(left, right); });
    }
    return left;
  }

  Part parse_product() {
    Part left = parse_signed();
    while (peek() == '*' || peek() == '/') {
      const std::size_t at = at_;
      const bool times = peek() == '*';
      take(peek());
      if (times && peek() == '*' && at_ == at + 1) fail(at, "unexpected '**'", "'^' for a power");
      const Part right = parse_signed();
      left = checked(at, [&] {
        return times ? builder_.product(left, right) : builder_.quotient(left, right);
      });
    }
    return left;
  }

  Part parse_signed() {
    const std::size_t at = at_;
    bool negative = false;
    while (peek() == '+' || peek() == '-') {
      negative = negative != (peek() == '-');
      take(peek());
    }
    const Part value = parse_power();
    return negative ? checked(at, [&] { return builder_.negative(value); }) : value;
  }

  Part parse_power() {
    const Part value = parse_primary();
    const std::size_t at = at_;
    if (!take('^')) return value;
    const std::size_t exponent_at = at_;
    descend(at);
    const Part exponent = parse_signed();
    --depth_;
    if (exponent.is_number && std::fabs(exponent.number) > most_exponent) {
      fail(exponent_at, "the exponent is too large",
           "at most " + std::to_string(static_cast<int>(most_exponent)) + " in size");
    }
    return checked(at, [&] { return builder_.power(value, exponent); });
  }

  Part parse_primary() {
    const std::size_t at = at_;
    if (take('(')) {
      const Part inside = parse_inside(at);
      if (!take(')')) fail_after_operand(closing(at));
      return inside;
    }
    if (is_digit(peek()) || (peek() == '.' && digit_at(at_ + 1))) return parse_decimal();
    if (!is_letter(peek())) fail(at_, found(), "a number, a name or '('");
    while (is_letter(peek()) || is_digit(peek())) ++at_;
    const std::string word(text_.substr(at, at_ - at));
    skip_blanks();
    if (const Function* function = function_named(word)) return parse_call(*function, at);
    const std::optional<Part> part = part_named(word);
    if (!part) fail_unknown(word, at);
    if (peek() == '(') fail(at_, "'" + word + "' is no function", "an operator (* for a product)");
    return *part;
  }

  std::optional<Part> part_named(const std::string& word) const {
    for (std::size_t v = 0; v < variables_.size(); ++v)
      if (variables_[v] == word) return builder_.variable(v);
    if (const auto p = parameters_.find(word); p != parameters_.end())
      return Builder::number(p->second);
    for (const auto& [name, value] : constants)
      if (name == word) return Builder::number(value);
    return {};
  }

  [[noreturn]] void fail_unknown(const std::string& word, std::size_t at) const {
    std::vector<std::string> of_functions, of_parameters, of_constants;
    for (const Function& f : functions) of_functions.emplace_back(f.name);
    for (const auto& p : parameters_) of_parameters.push_back(p.first);
    for (const auto& c : constants) of_constants.emplace_back(c.first);
    std::vector<std::string> all = of_functions;
    if (peek() == '(') {
      fail(at, "unknown function '" + word + "'", joined(of_functions), nearest_name(word, all));
    }
    if (word == "inf" || word == "nan" || word == "infinity")
      fail(at, "'" + word + "' is not a finite number");
    std::vector<std::string> values = names(variables_);
    values.insert(values.end(), of_parameters.begin(), of_parameters.end());
    values.insert(values.end(), of_constants.begin(), of_constants.end());
    all.insert(all.begin(), values.begin(), values.end());
    fail(at, "unknown name '" + word + "'", joined(values) + " or a function",
         nearest_name(word, all));
  }

  Part parse_call(const Function& function, std::size_t at) {
    const std::string name = function.name;
    const std::size_t open = at_;
    const std::string takes =
        name + (function.arguments == 1 ? " takes one argument"
                                        : " takes two arguments, separated by ','");
    if (!take('(')) fail(at_, found(), "'(' after " + name);
    if (peek() == ')') fail(at_, found(), "an argument: " + takes);
    const Part first = parse_inside(open);
    if (function.arguments == 1) {
      if (peek() == ',') fail(at_, "unexpected ','", "')': " + takes);
      if (!take(')')) fail_after_operand(closing(open));
      return checked(at, [&] { return builder_.unary(function.operation, first); });
    }
    if (peek() == ')') fail(at_, "unexpected ')'", "',': " + takes);
    if (!take(',')) fail_after_operand("','");
    const Part second = parse_inside(open);
    if (peek() == ',') fail(at_, "unexpected ','", "')': " + takes);
    if (!take(')')) fail_after_operand(closing(open));
    return checked(at, [&] { return builder_.binary(function.operation, first, second); });
  }

  // What stands inside a parenthesis that was opened at `open`.
  Part parse_inside(std::size_t open) {
    descend(open);
    const Part inside = parse_sum();
    --depth_;
    return inside;
  }
  std::string closing(std::size_t open) const {
    return "')' for the one opened at character " + std::to_string(character(open));
  }
  void descend(std::size_t at) {
    if (++depth_ > most_depth)
      fail(at, "nested too deeply", "at most " + std::to_string(most_depth) + " levels");
  }

  // digits [ "." digits ] [ "e" [sign] digits ]; 2exp(x) is no exponent, and a product lacks its
  // sign.
  Part parse_decimal() {
    const std::size_t start = at_;
    const auto skip_digits = [this] {
      while (is_digit(peek())) ++at_;
    };
    skip_digits();
    if (peek() == '.') {
      ++at_;
      skip_digits();
    }
    const bool signs = at_ + 1 < text_.size() && (text_[at_ + 1] == '+' || text_[at_ + 1] == '-');
    if ((peek() == 'e' || peek() == 'E') && digit_at(at_ + (signs ? 2 : 1))) {
      at_ += signs ? 2 : 1;
      skip_digits();
    }
    const std::string_view written = text_.substr(start, at_ - start);
    skip_blanks();
    try {
      return Builder::number(ExactNumber(written, Place{}).to_double());
    } catch (const InputError& error) {
      fail(start, "'" + std::string(written) + "' is no double: " + error.problem(),
           error.expected());
    }
  }

  std::string_view text_;
  const Place& place_;
  std::span<const std::string> variables_;
  const std::map<std::string, double>& parameters_;
  Builder builder_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

Formula parse(std::string_view text, std::span<const std::string> variables,
              const std::map<std::string, double>& parameters, const Place& place) {
  if (variables.empty() || variables.size() > most_variables) {
    throw InternalError("formulas have one to three variables");
  }
  return Parser(text, variables, parameters, place).parse();
}

}  // namespace carom::forces::formula
