// The words of typed formulas.
#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <string_view>

#include "base/expression_grammar.hpp"

namespace carom::base {

/// Of a formula. a, b: results of earlier operations; c: a number. From `root` on, words.
enum class Operation : std::uint8_t {
  number,        // c
  negative,      // -a
  sum,           // a + b
  shifted,       // a + c
  difference,    // a - b
  number_minus,  // c - a
  product,       // a b
  multiple,      // c a
  quotient,      // a / b
  share,         // a / c
  number_over,   // c / a
  whole_power,   // a^n
  half_power,    // a^n sqrt(a)
  real_power,    // a^c
  power,         // a^b
  root,
  exp,
  log,
  sin,
  cos,
  tan,
  sinh,
  cosh,
  tanh,
  abs,
  atan2,
  least,
  greatest
};

struct FormulaWord {
  const char* name;
  Operation operation;
  int arguments;
};
inline constexpr FormulaWord formula_words[] = {
    {"sqrt", Operation::root, 1},  {"exp", Operation::exp, 1},   {"log", Operation::log, 1},
    {"sin", Operation::sin, 1},    {"cos", Operation::cos, 1},   {"tan", Operation::tan, 1},
    {"sinh", Operation::sinh, 1},  {"cosh", Operation::cosh, 1}, {"tanh", Operation::tanh, 1},
    {"abs", Operation::abs, 1},    {"min", Operation::least, 2}, {"max", Operation::greatest, 2},
    {"atan2", Operation::atan2, 2}};

/// A function by its name, or null.
inline const FormulaWord* formula_word(std::string_view name) {
  const auto* const found = std::find_if(std::begin(formula_words), std::end(formula_words),
                                         [&](const FormulaWord& w) { return w.name == name; });
  return found == std::end(formula_words) ? nullptr : found;
}
/// Of a function; 0 of other names.
inline int arguments_of_formula_word(std::string_view name) {
  const FormulaWord* const word = formula_word(name);
  return word == nullptr ? 0 : word->arguments;
}

inline constexpr Dialect formula_dialect{.subject = "formula",
                                         .operand = "a number, a name or '('",
                                         .product = "an operator (* for a product)",
                                         .unclosed_before = "an operator (+ - * / ^) or ",
                                         .blanks = " \t\n\r",
                                         .e_is_a_name = true,
                                         .column_in_file = true};

}  // namespace carom::base
