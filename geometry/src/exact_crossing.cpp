#include "exact_crossing.hpp"

#include <utility>

namespace carom::geometry {

AlgebraicRoot Crossing::algebraic() const {
  if (root) return *root;
  if (q.sign() != 0)
    return rising_roots({quadratic.c, Dyadic(2) * quadratic.b, quadratic.a}).front();
  return rising_roots({-p, r * Dyadic(r.sign())}).front();  // r kappa - p, rising
}

int compare(const Crossing& a, const Crossing& b) {
  if (a.root || b.root) return compare(a.algebraic(), b.algebraic());
  const int s = sign_with_two_roots(a.p * b.r - b.p * a.r, a.q * b.r, a.d, -(b.q * a.r), b.d);
  return s * a.r.sign() * b.r.sign();
}

int sign_of_kappa(const Crossing& a) {
  if (a.root) return compare(*a.root, mpq_class(0));
  return sign_with_root(a.p, a.q, a.d) * a.r.sign();
}

Crossing rational_crossing(Dyadic p, Dyadic r) {
  Crossing c;
  c.p = std::move(p);
  c.r = std::move(r);
  if (c.r.sign() < 0) {
    c.p = -c.p;
    c.r = -c.r;
  }
  return c;
}

double approximate(const Crossing& k) {
  if (k.root) return approximate(*k.root);
  constexpr int bits = 512;  // far beyond what p + q sqrt(d) can cancel between doubles
  const auto real = [](const Dyadic& x) { return mpf_class(x.rational(), bits); };
  const mpf_class numerator = real(k.p) + real(k.q) * sqrt(real(k.d));
  return mpf_class(numerator / real(k.r)).get_d();
}

std::optional<Crossing> quadratic_crossing(const Quadratic<Dyadic>& f, int rising) {
  if (f.a.sign() == 0) {
    if (f.b.sign() != rising) return std::nullopt;
    return rational_crossing(-f.c, Dyadic(2) * f.b);
  }
  Crossing crossing;
  crossing.d = discriminant_of(f);
  if (crossing.d.sign() <= 0) return std::nullopt;
  crossing.p = -f.b;
  crossing.q = Dyadic(rising);
  crossing.r = f.a;
  crossing.quadratic = f;
  return crossing;
}

int sign_at_crossing(const Quadratic<Dyadic>& f, const Crossing& k) {
  if (k.root) return sign_at({f.c, Dyadic(2) * f.b, f.a}, *k.root);
  // f r^2 = g + h sqrt(d), where kappa r = p + q sqrt(d).
  const Dyadic half_slope = f.a * k.p + f.b * k.r;
  return sign_with_root(
      f.a * (k.p * k.p + k.q * k.q * k.d) + Dyadic(2) * f.b * k.p * k.r + f.c * k.r * k.r,
      Dyadic(2) * half_slope * k.q, k.d);
}

}  // namespace carom::geometry
