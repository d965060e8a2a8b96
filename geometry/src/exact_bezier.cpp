#include "exact_bezier.hpp"

#include <algorithm>
#include <utility>

#include "exact_piece.hpp"

namespace carom::geometry {

namespace {

/// a . (x(u) - start) times start.w, as a polynomial in u.
Polynomial form_of(const FlightAtCurve& l, const DyadicVector& a) {
  Polynomial f;
  for (const DyadicVector& x : l.curve.power) f.push_back(l.start.w * dot(a, x));
  f[0] = f[0] - dot(a, DyadicVector{l.start.x, l.start.y});
  return f;
}
/// |x(u) - start|^2 times start.w^2.
Polynomial square_of(const FlightAtCurve& l) {
  const Polynomial x = form_of(l, {Dyadic(1), Dyadic(0)}), y = form_of(l, {Dyadic(0), Dyadic(1)});
  return plus(times(x, x), times(y, y));
}
/// The side of the flight on which x(u) lies, times a positive factor: 2 v x d + omega d.d,
/// d = x(u) - start; without field v x d.
Polynomial side_of(const FlightAtCurve& l) {
  const Polynomial g = form_of(l, left(l.v));
  if (l.omega.sign() == 0) return g;
  return plus(times(Dyadic(2) * l.start.w, g), times(l.omega, square_of(l)));
}

/// p / (u - at), at a root.
Polynomial without_root(const Polynomial& p, const Dyadic& at) {
  Polynomial q(p.size() - 1);
  Dyadic carry(0);
  for (std::size_t k = p.size() - 1; k > 0; --k) q[k - 1] = carry = p[k] + at * carry;
  return q;
}

/// Finds the crossings at roots that lie ahead.
class Crossings {
 public:
  explicit Crossings(const FlightAtCurve& l)
      : straight_(l.omega.sign() == 0),
        along_(form_of(l, l.v)),
        square_(straight_ ? Polynomial{l.start.w * dot(l.v, l.v)} : square_of(l)) {
    if (!straight_) along_ = times(l.start.w, along_);
  }
  void add(const AlgebraicRoot& u) {
    if (straight_ && sign_at(along_, u) <= 0) return;
    Crossing k;
    // Without field kappa = |v|^2 / (v.d), which is 1/t; in a field v.d / d.d.
    k.root = straight_ ? quotient_at(square_, along_, u) : quotient_at(along_, square_, u);
    k.place = u;
    found.push_back(std::move(k));
  }
  std::vector<Crossing> found;

 private:
  bool straight_;
  Polynomial along_, square_;  // of d; without field |v|^2
};

/// Calls visit(root, sign of the side just before it, multiplicity) for each root of the side in
/// (0, 1] at which the particle does not stand, ascending.
void roots_of(const FlightAtCurve& l, const auto& visit) {
  Polynomial g = side_of(l);
  for (const Dyadic& u : l.known) g = without_root(g, u);
  while (!g.empty() && g.back().sign() == 0) g.pop_back();
  if (g.size() < 2 || keeps_sign_in_unit(g)) return;
  int sign = g.back().sign() * (g.size() % 2 != 0 ? 1 : -1);  // at -infinity
  for (const RealRoot& root : real_roots(g)) {
    const int before = sign;
    if (root.multiplicity % 2 != 0) sign = -sign;
    if (compare(root.value, mpq_class(0)) <= 0) continue;
    if (compare(root.value, mpq_class(1)) > 0) return;
    int known = 1;  // sign of the product of u - known
    for (const Dyadic& u : l.known) known *= compare(root.value, u.rational());
    if (known != 0) visit(root.value, before * known, root.multiplicity);
  }
}

}  // namespace

std::vector<Crossing> exits(const FlightAtCurve& l) {
  Crossings crossings(l);
  roots_of(l, [&](const AlgebraicRoot& u, int before, int multiplicity) {
    if (before < 0 && multiplicity % 2 != 0) crossings.add(u);
  });
  std::sort(crossings.found.begin(), crossings.found.end(),
            [](const Crossing& a, const Crossing& b) { return compare(a, b) > 0; });
  return crossings.found;
}

std::vector<Crossing> touches(const FlightAtCurve& l) {
  Crossings crossings(l);
  roots_of(l, [&](const AlgebraicRoot& u, int, int multiplicity) {
    if (multiplicity % 2 == 0 && compare(u, mpq_class(1)) < 0) crossings.add(u);
  });
  return crossings.found;
}

AroundEnd around_end(const FlightAtCurve& l, bool at_end, const DyadicVector& velocity) {
  Polynomial g = side_of(l);
  if (at_end)  // in powers of u - 1
    for (std::size_t i = 0; i + 1 < g.size(); ++i)
      for (std::size_t k = g.size() - 1; k-- > i;) g[k] = g[k] + g[k + 1];
  std::size_t order = 1;
  while (order < g.size() && g[order].sign() == 0) ++order;
  if (order == g.size()) return {0, 0, true};
  const int after = g[order].sign(), before = order % 2 == 0 ? after : -after;
  // Where the curve rests it begins with u^2, or ends with (u - 1)^2, along its tangent.
  const DyadicVector& first = l.curve.power[1];
  const bool rests = at_end ? l.curve.rests_at_end() : first.x.sign() == 0 && first.y.sign() == 0;
  if (rests && order == 2)
    return at_end ? AroundEnd{-after, after, false} : AroundEnd{after, -after, false};
  if (order == 1) return {after, before, false};
  // Side by side: where the curve is on the flight's left, the flight is on its right if they run
  // the same way, else on its left, and comes from where the curve goes.
  const bool forwards = dot(l.curve.direction_at(at_end ? -1.0 : 0.0), velocity).sign() > 0;
  return forwards ? AroundEnd{-before, -after, true} : AroundEnd{after, before, true};
}

}  // namespace carom::geometry
