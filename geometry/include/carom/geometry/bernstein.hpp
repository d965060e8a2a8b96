// Polynomials on [0, 1] in Bernstein form, and how their roots are isolated there: by Descartes'
// rule, every root of the polynomial shows as a change of sign of its coefficients. Templates over
// the number: enclosures, values with an error bound, exact numbers.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "carom/base/sign.hpp"

namespace carom::geometry {

/// The polynomial lies between its smallest and its largest coefficient; b[0] and b[degree] are its
/// values at 0 and 1.
template <class Number, std::size_t most = 4>
struct BernsteinPolynomial {
  std::array<Number, most + 1> b{};
  std::size_t degree = most;
};

/// Of a polynomial given by its powers. `share(c, m, n)` is c m/n, or the same multiple of it for
/// all m and n; both are whole numbers, and n is 1 only where m is, too.
template <std::size_t most = 4, class Powers, class Share>
auto bernstein_form(const Powers& c, std::size_t degree, const Share& share)
    -> BernsteinPolynomial<decltype(share(c[0], 1, 1)), most> {
  BernsteinPolynomial<decltype(share(c[0], 1, 1)), most> p;
  p.degree = degree;
  for (std::size_t i = 0; i <= degree; ++i) {
    p.b[i] = share(c[0], 1, 1);
    int m = 1, n = 1;  // products of j falling factors
    for (std::size_t j = 1; j <= i; ++j) {
      m *= static_cast<int>(i + 1 - j);
      n *= static_cast<int>(degree + 1 - j);
      p.b[i] = p.b[i] + share(c[j], m, n);
    }
  }
  return p;
}

/// How often the sign of the coefficients changes. No change: no root; one: one root. An uncertain
/// coefficient between two certain neighbours of opposite sign changes nothing.
struct SignChanges {
  Sign first = Sign::undecided, last = Sign::undecided;  ///< at 0 and at 1
  bool certain = true;                                   ///< all signs are
  int least = 0, most = 0;
};
template <class Number, std::size_t most, class SignOf>
SignChanges sign_changes(const BernsteinPolynomial<Number, most>& p, const SignOf& sign_of) {
  std::array<Sign, most + 1> s{};
  SignChanges r;
  Sign before = Sign::undecided;
  const auto known = [](Sign a) { return a == Sign::negative || a == Sign::positive; };
  for (std::size_t i = 0; i <= p.degree; ++i) {
    s[i] = sign_of(p.b[i]);
    if (!known(s[i])) {
      r.certain = false;
      continue;
    }
    if (known(before) && s[i] != before) ++r.least;
    before = s[i];
  }
  r.first = s[0];
  r.last = s[p.degree];
  r.most = r.least;
  if (r.certain) return r;
  for (std::size_t i = 1; i < p.degree; ++i)
    if (!known(s[i]) && !(known(s[i - 1]) && s[i + 1] == -s[i - 1]))
      r.most = static_cast<int>(p.degree);
  return r;
}

/// Half of a + b.
template <class Number>
Number mean_of(const Number& a, const Number& b) {
  return Number(0.5) * (a + b);
}

/// The same polynomial on [0, 1/2] and on [1/2, 1].
template <class Number, std::size_t most = 4>
struct Halves {
  BernsteinPolynomial<Number, most> left, right;
};
template <class Number, std::size_t most>
Halves<Number, most> halves_of(const BernsteinPolynomial<Number, most>& p) {
  Halves<Number, most> h{p, p};
  for (std::size_t level = 1; level <= p.degree; ++level) {
    for (std::size_t k = 0; k + level <= p.degree; ++k)
      h.right.b[k] = mean_of(h.right.b[k], h.right.b[k + 1]);
    h.left.b[level] = h.right.b[0];
  }
  return h;
}

/// Halves [from, to], on which p is the polynomial, until `look(p, from, to, depth)` tells whether
/// the search goes on; it answers nothing where p must be halved. `ascending`: from `from` to `to`.
/// True if the search went on to the end.
template <class Number, std::size_t most, class Place, class Look>
bool isolate(const BernsteinPolynomial<Number, most>& p, const Place& from, const Place& to,
             bool ascending, int depth, const Look& look) {
  const std::optional<bool> goes_on = look(p, from, to, depth);
  if (goes_on) return *goes_on;
  const Halves<Number, most> half = halves_of(p);
  const Place middle = Place(0.5) * (from + to);
  if (ascending)
    return isolate(half.left, from, middle, ascending, depth + 1, look) &&
           isolate(half.right, middle, to, ascending, depth + 1, look);
  return isolate(half.right, middle, to, ascending, depth + 1, look) &&
         isolate(half.left, from, middle, ascending, depth + 1, look);
}

}  // namespace carom::geometry
