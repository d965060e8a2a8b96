// The words of typed formulas.
#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <string_view>

#include "base/expression_grammar.hpp"

namespace carom::base {

enum class FormulaFunction : std::uint8_t {
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
  FormulaFunction function;
  int arguments;
};
inline constexpr FormulaWord formula_words[] = {
    {"sqrt", FormulaFunction::root, 1},  {"exp", FormulaFunction::exp, 1},
    {"log", FormulaFunction::log, 1},    {"sin", FormulaFunction::sin, 1},
    {"cos", FormulaFunction::cos, 1},    {"tan", FormulaFunction::tan, 1},
    {"sinh", FormulaFunction::sinh, 1},  {"cosh", FormulaFunction::cosh, 1},
    {"tanh", FormulaFunction::tanh, 1},  {"abs", FormulaFunction::abs, 1},
    {"min", FormulaFunction::least, 2},  {"max", FormulaFunction::greatest, 2},
    {"atan2", FormulaFunction::atan2, 2}};

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
