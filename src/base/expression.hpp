// The parsed form of an exact number.
#pragma once

#include <gmpxx.h>
#include <mpfr.h>

#include <memory>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "carom/base/exact_number.hpp"

namespace carom::base {

/// A number in closed form, coefficient * sqrt(radicand) * pi^power: what most numbers of a table
/// are. Kept so that radicand is 1 where the root is rational, and radicand and power are 1 and 0
/// for zero.
struct ClosedForm {
  mpq_class coefficient = 0;
  mpq_class radicand = 1;  // > 0
  long power = 0;

  bool is_rational() const { return radicand == 1 && power == 0; }
};

}  // namespace carom::base

namespace carom {

/// One operation of an expression, or a leaf: what has a closed form is folded into one. A null
/// expression is zero.
struct ExactNumber::Node {
  enum class Operation { leaf, root, sum, difference, product, quotient, power };
  Operation operation = Operation::leaf;
  base::ClosedForm closed;  // of a leaf
  long exponent = 0;        // of a power
  std::shared_ptr<const Node> first, second;
};

}  // namespace carom

namespace carom::base::expression {

using Node = ExactNumber::Node;
using NodePointer = std::shared_ptr<const Node>;

/// Why an operation has no result; the parser adds the place.
class NoValue : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Numbers are kept exactly up to this many bits (numerator and denominator together).
inline constexpr std::size_t most_bits = 1u << 17;
/// Most bits spent on distinguishing a number from zero or from the midpoint of two doubles.
inline constexpr mpfr_prec_t most_precision = 1 << 14;

// Each folds what can be folded and throws NoValue where there is no value or it is too long.
NodePointer leaf(ClosedForm);
NodePointer root(const NodePointer&);
NodePointer sum(const NodePointer&, const NodePointer&);
NodePointer difference(const NodePointer&, const NodePointer&);
NodePointer product(const NodePointer&, const NodePointer&);
NodePointer quotient(const NodePointer&, const NodePointer&);
NodePointer power(const NodePointer&, long exponent);

/// Sign of the number; 0 also when `most_precision` bits cannot tell it from zero.
int sign(const Node&);
/// The nearest double, ties to even (a number that `most_precision` bits cannot tell from a tie is
/// taken as one); nothing on overflow. Throws NoValue when too many digits cancel.
std::optional<double> nearest_double(const Node&);

/// Parses a number; messages of the InputError count characters of `text` from 1.
NodePointer parse(std::string_view text, const Place& place);

}  // namespace carom::base::expression
