#include "exact_bezier.hpp"

#include <algorithm>
#include <utility>

#include "exact_piece.hpp"

namespace carom::geometry {

namespace {

/// p / (u - at), at a root.
Polynomial without_root(const Polynomial& p, const Dyadic& at) {
  Polynomial q(p.size() - 1);
  Dyadic carry(0);
  for (std::size_t k = p.size() - 1; k > 0; --k) q[k - 1] = carry = p[k] + at * carry;
  return q;
}

/// Crossing of the line at a root, if it lies ahead.
void add(std::vector<Crossing>& found, const LineAtCurve& l, const Polynomial& along,
         const AlgebraicRoot& u) {
  if (sign_at(along, u) <= 0) return;
  Crossing k;
  // kappa = 1 / t, t = v.(x - P) / |v|^2.
  k.root = quotient_at(l.start.w * dot(l.v, l.v), along, u);
  k.place = u;
  found.push_back(std::move(k));
}

/// Calls visit(root, sign of g just before it, multiplicity) for each root of
/// g = v x (x(u) - start) in (0, 1] at which the particle does not stand, ascending.
template <class Visit>
void roots_of(const LineAtCurve& l, const Visit& visit) {
  Polynomial g = form_of(l.curve, left(l.v), l.start);
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

Polynomial form_of(const ExactCurve& c, const DyadicVector& a, const ExactPoint& p) {
  Polynomial f;
  for (const DyadicVector& x : c.power) f.push_back(p.w * dot(a, x));
  f[0] = f[0] - dot(a, DyadicVector{p.x, p.y});
  return f;
}

std::vector<Crossing> exits(const LineAtCurve& l) {
  std::vector<Crossing> found;
  const Polynomial along = form_of(l.curve, l.v, l.start);
  roots_of(l, [&](const AlgebraicRoot& u, int before, int multiplicity) {
    if (before < 0 && multiplicity % 2 != 0) add(found, l, along, u);
  });
  std::sort(found.begin(), found.end(),
            [](const Crossing& a, const Crossing& b) { return compare(a, b) > 0; });
  return found;
}

std::vector<Crossing> touches(const LineAtCurve& l) {
  std::vector<Crossing> found;
  const Polynomial along = form_of(l.curve, l.v, l.start);
  roots_of(l, [&](const AlgebraicRoot& u, int, int multiplicity) {
    if (multiplicity % 2 == 0 && compare(u, mpq_class(1)) < 0) add(found, l, along, u);
  });
  return found;
}

AroundEnd around_end(const ExactCurve& c, bool at_end, const DyadicVector& v) {
  const DyadicVector tangent = c.direction_at(at_end ? -1.0 : 0.0);
  if (const int across = cross(tangent, v).sign(); across != 0) return {-across, across, false};
  // The curve leaves its tangent to the left by u^k times this, u counted from the end.
  std::vector<DyadicVector> power = c.power;
  if (at_end)
    for (std::size_t i = 0; i + 1 < power.size(); ++i)
      for (std::size_t k = power.size() - 1; k-- > i;) power[k] = power[k] + power[k + 1];
  for (std::size_t k = 2; k < power.size(); ++k) {
    const int bend = cross(tangent, power[k]).sign();
    if (bend == 0) continue;
    const int ahead = -bend, behind = k % 2 == 0 ? -bend : bend;
    const bool forwards = dot(tangent, v).sign() > 0;
    return {forwards ? behind : ahead, forwards ? ahead : behind, true};
  }
  return {0, 0, true};
}

}  // namespace carom::geometry
