#include "files/svg/affine.hpp"

#include <cmath>
#include <string>
#include <vector>

#include "carom/base/elementary.hpp"

namespace carom::files {
namespace {

constexpr std::size_t most_bits = 8192;  // of a number of a transform after all that it is within

struct Transform {
  const char* name;
  std::size_t least, most;  // numbers
};
constexpr Transform kinds[] = {{"matrix", 6, 6}, {"translate", 1, 2}, {"scale", 1, 2},
                               {"rotate", 1, 3}, {"skewX", 1, 1},     {"skewY", 1, 1}};

elementary::SinCos sincos_of(const Rational& degrees) {
  return elementary::sincos(nearest(degrees) * 0.017453292519943295);
}

Affine made(const std::string& name, const std::vector<Rational>& n) {
  if (name == "matrix") return {n[0], n[1], n[2], n[3], n[4], n[5]};
  if (name == "translate") return {1, 0, 0, 1, n[0], n.size() > 1 ? n[1] : Rational(0)};
  if (name == "scale") return {n[0], 0, 0, n.size() > 1 ? n[1] : n[0], 0, 0};
  if (name == "rotate") {
    const Affine about_origin = turn(n[0]);
    if (n.size() == 1) return about_origin;
    const Affine to{1, 0, 0, 1, n[1], n[2]}, from{1, 0, 0, 1, -n[1], -n[2]};
    return to.after(about_origin.after(from));
  }
  const elementary::SinCos t = sincos_of(n[0]);
  const Rational tangent(n[0] == 45 ? 1.0 : n[0] == -45 ? -1.0 : t.sin / t.cos);
  return name == "skewX" ? Affine{1, 0, tangent, 1, 0, 0} : Affine{1, tangent, 0, 1, 0, 0};
}

}  // namespace

Affine Affine::inverse() const {
  const Rational det = determinant();
  Affine m{d / det, -b / det, -c / det, a / det, 0, 0};
  const DrawnPoint shift = m.linear({e, f});
  m.e = -shift.x;
  m.f = -shift.y;
  return m;
}

Affine Affine::after(const Affine& first) const {
  const DrawnPoint x = linear({first.a, first.b}), y = linear({first.c, first.d}),
                   shift = (*this)({first.e, first.f});
  return {x.x, x.y, y.x, y.y, shift.x, shift.y};
}

Affine turn(const Rational& degrees) {
  Rational quarters = degrees / 90;
  if (quarters.get_den() == 1) {
    const mpz_class number = quarters.get_num();
    static constexpr int cosines[] = {1, 0, -1, 0};
    const unsigned long k = mpz_fdiv_ui(number.get_mpz_t(), 4);
    const int cosine = cosines[k], sine = cosines[(k + 3) % 4];
    return {cosine, sine, -sine, cosine, 0, 0};
  }
  const elementary::SinCos t = sincos_of(degrees);
  return {Rational(t.cos), Rational(t.sin), Rational(-t.sin), Rational(t.cos), 0, 0};
}

void check_size(const Affine& m, const Place& place) {
  for (const Rational* n : {&m.a, &m.b, &m.c, &m.d, &m.e, &m.f})
    if (mpz_sizeinbase(n->get_num_mpz_t(), 2) + mpz_sizeinbase(n->get_den_mpz_t(), 2) > most_bits)
      throw InputError(place, "the transforms are too long to be multiplied out",
                       "fewer of them, or numbers with fewer digits");
  if (m.determinant() == 0)
    throw InputError(place, "the transform makes everything flat", "an invertible transform");
}

Affine transform_of(const XmlAttribute& attribute, const Locator& locator) {
  Scanner text(attribute, locator);
  Affine whole;
  for (text.skip_spaces(); !text.at_end();) {
    const Place place = text.place();
    const std::string name(text.word());
    const Transform* kind = nullptr;
    for (const Transform& k : kinds)
      if (name == k.name) kind = &k;
    const std::string expected = "matrix, translate, scale, rotate, skewX or skewY";
    if (kind == nullptr) throw InputError(place, "unknown transform '" + name + "'", expected);
    text.skip_spaces();
    if (!text.take('(')) text.fail("no '(' follows " + name, "'('");
    std::vector<Rational> numbers;
    for (text.skip_spaces(); !text.take(')'); text.skip_separator()) {
      if (numbers.size() == kind->most)
        text.fail("too many numbers of " + name, "at most " + std::to_string(kind->most));
      numbers.push_back(text.number("a number of a transform"));
      if (text.at_end()) text.fail("no ')' ends " + name, "')'");
    }
    if (numbers.size() < kind->least || (name == "rotate" && numbers.size() == 2))
      throw InputError(place, std::to_string(numbers.size()) + " numbers of " + name,
                       name == "rotate" ? "an angle, or an angle and a point"
                                        : std::to_string(kind->most) + " numbers");
    whole = whole.after(made(name, numbers));
    check_size(whole, place);
    text.skip_spaces();
    text.take(',');
    text.skip_spaces();
  }
  return whole;
}

Axes axes_of(const Affine& m, const Place& place) {
  const Rational p = m.a * m.a + m.c * m.c, q = m.a * m.b + m.c * m.d, s = m.b * m.b + m.d * m.d;
  if (q == 0) return {p, s, ExactNumber("0", place)};
  // The eigenvalues of the matrix (p q; q s), and half of the angle of its larger one. The smaller
  // one is the determinant over the larger, without a difference that cancels.
  const double half = 0.5 * nearest(p - s), off = nearest(q);
  const double larger = 0.5 * nearest(p + s) + std::sqrt(half * half + off * off);
  if (!(larger > 1e-60 && larger < 1e60))
    throw InputError(place, "the transform is out of range", "lengths between 1e-30 and 1e30");
  const Rational square(larger), det = m.determinant();
  return {square, det * det / square,
          ExactNumber(ExactNumber(0.5 * elementary::atan2(off, half)).text(), place)};
}

}  // namespace carom::files
