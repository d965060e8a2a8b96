// A typed formula as a list of operations, and how the list grows.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "base/formula_words.hpp"
#include "carom/forces/typed_expression.hpp"

namespace carom::forces::formula {

using base::Operation;

struct Instruction {
  double c = 0.0;
  int n = 0;
  std::uint16_t a = 0, b = 0;
  Operation operation = Operation::number;
};

inline constexpr std::size_t most_variables = 3;
inline constexpr std::size_t most_slots = 2048;

/// A part of a formula: a number, or the slot that holds its value.
struct Part {
  bool is_number = true;
  double number = 0.0;
  std::uint16_t slot = 0;
};

}  // namespace carom::forces::formula

namespace carom {

/// Slots hold values: first the variables, then the result of each instruction.
struct TypedExpression::Formula {
  std::size_t variables = 0;
  std::vector<forces::formula::Instruction> instructions;
  std::size_t result = 0;
};

}  // namespace carom

namespace carom::forces::formula {

using Formula = TypedExpression::Formula;

/// Too many operations.
struct TooLong {};

/// Writes the list: operations on numbers are done at once, by the same code that runs the list;
/// what occurs twice is computed once.
class Builder {
 public:
  explicit Builder(std::size_t variables) { formula_.variables = variables; }

  Part variable(std::size_t index) const { return {false, 0.0, static_cast<std::uint16_t>(index)}; }
  static Part number(double c) { return {true, c, 0}; }
  Part negative(Part a) { return unary(Operation::negative, a); }
  Part sum(Part a, Part b);
  Part difference(Part a, Part b);
  Part product(Part a, Part b);
  Part quotient(Part a, Part b);
  Part power(Part a, Part b);
  Part unary(Operation, Part a);
  Part binary(Operation, Part a, Part b);
  /// Drops what the result does not need.
  Formula finish(Part result);

 private:
  using Key = std::tuple<Operation, std::uint16_t, std::uint16_t, std::uint64_t>;
  Part append(Instruction);
  Part in_slot(Part);
  static Part fold(Instruction, double a, double b);

  Formula formula_;
  std::map<Key, std::uint16_t> known_;
};

/// Largest size of a whole exponent.
inline constexpr double most_exponent = 10000.0;

Formula parse(std::string_view text, std::span<const std::string> variables,
              const std::map<std::string, double>& parameters, const Place& place);

}  // namespace carom::forces::formula
