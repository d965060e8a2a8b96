// The words of typed formulas.
#pragma once

#include <algorithm>
#include <iterator>
#include <string_view>

#include "base/expression_grammar.hpp"
#include "forces/formula.hpp"

namespace carom::forces::formula {

struct Function {
  const char* name;
  Operation operation;
  int arguments;
};
inline constexpr Function functions[] = {
    {"sqrt", Operation::root, 1},  {"exp", Operation::exp, 1},   {"log", Operation::log, 1},
    {"sin", Operation::sin, 1},    {"cos", Operation::cos, 1},   {"tan", Operation::tan, 1},
    {"sinh", Operation::sinh, 1},  {"cosh", Operation::cosh, 1}, {"tanh", Operation::tanh, 1},
    {"abs", Operation::abs, 1},    {"min", Operation::least, 2}, {"max", Operation::greatest, 2},
    {"atan2", Operation::atan2, 2}};

/// A function by its name, or null.
inline const Function* function_named(std::string_view word) {
  const auto* const found = std::find_if(std::begin(functions), std::end(functions),
                                         [&](const Function& f) { return f.name == word; });
  return found == std::end(functions) ? nullptr : found;
}

inline constexpr base::Dialect dialect{.subject = "formula",
                                       .operand = "a number, a name or '('",
                                       .product = "an operator (* for a product)",
                                       .unclosed_before = "an operator (+ - * / ^) or ",
                                       .blanks = " \t\n\r",
                                       .e_is_a_name = true,
                                       .column_in_file = true};

}  // namespace carom::forces::formula
