// Operations on expressions, folded where the result has a closed form.
#include <cstdlib>
#include <utility>

#include "expression.hpp"

namespace carom::base::expression {
namespace {

std::size_t bits(const mpq_class& q) {
  return mpz_sizeinbase(q.get_num_mpz_t(), 2) + mpz_sizeinbase(q.get_den_mpz_t(), 2);
}

bool is_square(const mpq_class& q) {
  return mpz_perfect_square_p(q.get_num_mpz_t()) != 0 &&
         mpz_perfect_square_p(q.get_den_mpz_t()) != 0;
}

mpq_class square_root(const mpq_class& square) {
  mpq_class result;
  mpz_sqrt(result.get_num_mpz_t(), square.get_num_mpz_t());
  mpz_sqrt(result.get_den_mpz_t(), square.get_den_mpz_t());
  return result;
}

// The unique form of zero and of rational roots.
ClosedForm reduced(ClosedForm x) {
  if (sgn(x.coefficient) == 0) return {};
  if (x.radicand != 1 && is_square(x.radicand)) {
    x.coefficient *= square_root(x.radicand);
    x.radicand = 1;
  }
  if (bits(x.coefficient) + bits(x.radicand) > most_bits) throw NoValue("the number is too long");
  if (std::abs(x.power) > 1000000) throw NoValue("the power of pi is too large");
  return x;
}

const ClosedForm* closed(const NodePointer& x) {
  return x->operation == Node::Operation::leaf ? &x->closed : nullptr;
}

NodePointer operation(Node::Operation kind, NodePointer first, NodePointer second = nullptr,
                      long exponent = 0) {
  auto node = std::make_shared<Node>();
  node->operation = kind;
  node->first = std::move(first);
  node->second = std::move(second);
  node->exponent = exponent;
  return node;
}

ClosedForm inverse(const ClosedForm& x) { return {1 / x.coefficient, 1 / x.radicand, -x.power}; }

ClosedForm negated(ClosedForm x) {
  x.coefficient = -x.coefficient;
  return x;
}

mpq_class raised(const mpq_class& x, unsigned long exponent) {
  mpq_class result;
  mpz_pow_ui(result.get_num_mpz_t(), x.get_num_mpz_t(), exponent);
  mpz_pow_ui(result.get_den_mpz_t(), x.get_den_mpz_t(), exponent);
  return result;
}

// Two closed forms add to one where they differ by a rational factor.
std::optional<ClosedForm> closed_sum(const ClosedForm& x, const ClosedForm& y) {
  if (sgn(x.coefficient) == 0) return y;
  if (sgn(y.coefficient) == 0) return x;
  if (x.power != y.power) return std::nullopt;
  const mpq_class ratio = y.radicand / x.radicand;
  if (!is_square(ratio)) return std::nullopt;
  return ClosedForm{x.coefficient + y.coefficient * square_root(ratio), x.radicand, x.power};
}

}  // namespace

NodePointer leaf(ClosedForm x) {
  auto node = std::make_shared<Node>();
  node->closed = reduced(std::move(x));
  return node;
}

NodePointer root(const NodePointer& x) {
  const int s = sign(*x);
  if (s < 0) throw NoValue("square root of a negative number");
  if (s == 0) return leaf({});
  const ClosedForm* c = closed(x);
  if (c != nullptr && c->radicand == 1 && c->power % 2 == 0)
    return leaf({1, c->coefficient, c->power / 2});
  return operation(Node::Operation::root, x);
}

NodePointer sum(const NodePointer& x, const NodePointer& y) {
  if (closed(x) != nullptr && closed(y) != nullptr) {
    if (auto total = closed_sum(*closed(x), *closed(y))) return leaf(*std::move(total));
  }
  return operation(Node::Operation::sum, x, y);
}

NodePointer difference(const NodePointer& x, const NodePointer& y) {
  if (closed(y) != nullptr) return sum(x, leaf(negated(*closed(y))));
  return operation(Node::Operation::difference, x, y);
}

NodePointer product(const NodePointer& x, const NodePointer& y) {
  const ClosedForm *a = closed(x), *b = closed(y);
  if (a != nullptr && b != nullptr) {
    return leaf({a->coefficient * b->coefficient, a->radicand * b->radicand, a->power + b->power});
  }
  return operation(Node::Operation::product, x, y);
}

NodePointer quotient(const NodePointer& x, const NodePointer& y) {
  if (sign(*y) == 0) throw NoValue("division by zero");
  if (closed(y) != nullptr) return product(x, leaf(inverse(*closed(y))));
  return operation(Node::Operation::quotient, x, y);
}

NodePointer power(const NodePointer& x, long exponent) {
  if (exponent == 0) return leaf({1, 1, 0});
  if (exponent == 1) return x;
  if (exponent < 0 && sign(*x) == 0) throw NoValue("division by zero");
  const ClosedForm* c = closed(x);
  if (c == nullptr) return operation(Node::Operation::power, x, nullptr, exponent);
  if (sgn(c->coefficient) == 0) return x;
  const ClosedForm factor = exponent < 0 ? inverse(*c) : *c;
  const auto n = static_cast<unsigned long>(std::labs(exponent));
  // (c sqrt(r) pi^k)^n = c^n r^(n/2) sqrt(r)^(n mod 2) pi^(k n)
  const std::size_t length = bits(factor.coefficient) + bits(factor.radicand);
  const bool unit = abs(factor.coefficient) == 1 && factor.radicand == 1;
  if (!unit && length * n > 2 * most_bits) throw NoValue("the number is too long");
  return leaf({raised(factor.coefficient, n) * raised(factor.radicand, n / 2),
               n % 2 == 0 ? mpq_class(1) : factor.radicand, factor.power * static_cast<long>(n)});
}

}  // namespace carom::base::expression
