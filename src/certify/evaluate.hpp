// An exact expression in any arithmetic.
#pragma once

#include "base/expression.hpp"

namespace carom::certify {

/// leaf_of(ClosedForm) and power_of(number, exponent) are what an arithmetic does in its own way.
template <class N, class Leaf, class Power>
N evaluate(const ExactNumber::Node& x, const Leaf& leaf_of, const Power& power_of) {
  using Operation = ExactNumber::Node::Operation;
  const auto first = [&] { return evaluate<N>(*x.first, leaf_of, power_of); };
  const auto second = [&] { return evaluate<N>(*x.second, leaf_of, power_of); };
  switch (x.operation) {
    case Operation::leaf:
      return leaf_of(x.closed);
    case Operation::root:
      return sqrt(first());
    case Operation::sum:
      return first() + second();
    case Operation::difference:
      return first() - second();
    case Operation::product:
      return first() * second();
    case Operation::quotient:
      return first() / second();
    case Operation::power:
      break;
  }
  return power_of(first(), x.exponent);
}

}  // namespace carom::certify
