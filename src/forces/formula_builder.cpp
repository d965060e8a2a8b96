#include <bit>
#include <cmath>

#include "forces/dual.hpp"
#include "forces/formula.hpp"
#include "forces/formula_evaluation.hpp"

namespace carom::forces::formula {

Part Builder::fold(Instruction instruction, double a, double b) {
  instruction.a = 0;
  instruction.b = 1;
  const Formula alone{2, {instruction}, 2};
  Dual<0> at[most_variables];
  at[0] = a;
  at[1] = b;
  return number(run(alone, at).v);
}

Part Builder::append(Instruction i) {
  const bool commutes = i.operation == Operation::sum || i.operation == Operation::product;
  if (commutes && i.b < i.a) std::swap(i.a, i.b);
  const Key key{i.operation, i.a, i.b, std::bit_cast<std::uint64_t>(i.c)};
  if (const auto found = known_.find(key); found != known_.end())
    return {false, 0.0, found->second};
  const std::size_t slot = formula_.variables + formula_.instructions.size();
  if (slot >= most_slots) throw TooLong{};
  formula_.instructions.push_back(i);
  known_.emplace(key, static_cast<std::uint16_t>(slot));
  return {false, 0.0, static_cast<std::uint16_t>(slot)};
}

Part Builder::in_slot(Part p) { return p.is_number ? append({.c = p.number}) : p; }

Part Builder::unary(Operation operation, Part a) {
  const Instruction i{.a = a.slot, .operation = operation};
  return a.is_number ? fold(i, a.number, 0.0) : append(i);
}

Part Builder::binary(Operation operation, Part a, Part b) {
  if (a.is_number && b.is_number) return fold({.operation = operation}, a.number, b.number);
  a = in_slot(a);
  b = in_slot(b);
  return append({.a = a.slot, .b = b.slot, .operation = operation});
}

Part Builder::sum(Part a, Part b) {
  if (a.is_number == b.is_number) return binary(Operation::sum, a, b);
  if (a.is_number) std::swap(a, b);
  return append({.c = b.number, .a = a.slot, .operation = Operation::shifted});
}

Part Builder::difference(Part a, Part b) {
  if (a.is_number == b.is_number) return binary(Operation::difference, a, b);
  if (a.is_number)
    return append({.c = a.number, .a = b.slot, .operation = Operation::number_minus});
  return append({.c = -b.number, .a = a.slot, .operation = Operation::shifted});
}

Part Builder::product(Part a, Part b) {
  if (a.is_number == b.is_number) return binary(Operation::product, a, b);
  if (a.is_number) std::swap(a, b);
  return append({.c = b.number, .a = a.slot, .operation = Operation::multiple});
}

Part Builder::quotient(Part a, Part b) {
  if (a.is_number == b.is_number) return binary(Operation::quotient, a, b);
  if (a.is_number) return append({.c = a.number, .a = b.slot, .operation = Operation::number_over});
  return append({.c = b.number, .a = a.slot, .operation = Operation::share});
}

Part Builder::power(Part a, Part b) {
  if (!b.is_number) return binary(Operation::power, a, b);
  Instruction i{.c = b.number, .a = a.slot, .operation = Operation::real_power};
  if (std::fabs(b.number) <= most_exponent) {
    const double below = std::floor(b.number);
    if (b.number == 0.0) return number(1.0);
    if (b.number == 1.0) return a;
    i.n = static_cast<int>(below);
    if (b.number == 0.5)
      i.operation = Operation::root;
    else if (b.number == below)
      i.operation = Operation::whole_power;
    else if (b.number == below + 0.5)
      i.operation = Operation::half_power;
    else
      i.n = 0;
  }
  if (i.operation == Operation::root) i = {.a = a.slot, .operation = Operation::root};
  return a.is_number ? fold(i, a.number, 0.0) : append(i);
}

Formula Builder::finish(Part result) {
  result = in_slot(result);
  const std::size_t variables = formula_.variables;
  std::vector<bool> needed(variables + formula_.instructions.size(), false);
  needed[result.slot] = true;
  for (std::size_t k = formula_.instructions.size(); k-- > 0;) {
    if (!needed[variables + k]) continue;
    // An operand an operation does not use is slot 0, a variable: harmless.
    needed[formula_.instructions[k].a] = true;
    needed[formula_.instructions[k].b] = true;
  }
  Formula kept{variables, {}, 0};
  std::vector<std::uint16_t> moved(needed.size());
  for (std::size_t v = 0; v < variables; ++v) moved[v] = static_cast<std::uint16_t>(v);
  for (std::size_t k = 0; k < formula_.instructions.size(); ++k) {
    if (!needed[variables + k]) continue;
    moved[variables + k] = static_cast<std::uint16_t>(variables + kept.instructions.size());
    Instruction i = formula_.instructions[k];
    i.a = moved[i.a];
    i.b = moved[i.b];
    kept.instructions.push_back(i);
  }
  kept.result = moved[result.slot];
  return kept;
}

}  // namespace carom::forces::formula
