// The flight of a free particle and where it meets walls: formulas over any arithmetic.
//
// With kappa = (omega/2) cot(omega t/2), which is 1/t without field, the flight from P with
// velocity v is
//     x = P + L / N,   L = kappa v + (omega/2) J v,   N = kappa^2 + omega^2/4,   J v = (v_y, -v_x).
// While t runs over one turn kappa falls from +infinity through 0 (half a turn) to -infinity, so
// hits are ordered by falling kappa; without field only kappa > 0 lies ahead. A wall is F(x) = 0
// with F > 0 on the domain's side; F(x) N is a polynomial in kappa whose leading coefficient is
// F(P), which vanishes for the wall that the particle is on: the known root is removed by
// algebra. The particle leaves the domain where F falls in time, that is where dF/dkappa > 0.
//
// A formula here never chooses: it maps numbers to numbers by + - * / and sqrt. Error bounds are in
// filter.hpp; docs/physics/exactness.md derives both. Products are fused with a sum where straight
// flights and landings take them: those round less than their bounds allow for.
// (carom/base/fused_product.hpp)
#pragma once

#include "carom/base/fused_product.hpp"
#include "carom/geometry/vector.hpp"

namespace carom::geometry {

/// a . b and a x b, the second product and the sum rounded at once. So a x a need not be 0, nor a x
/// b = -(b x a).
template <class Number>
constexpr Number fused_dot(const BasicVector<Number>& a, const BasicVector<Number>& b) {
  return fused_product(a.y, b.y, a.x * b.x);
}
template <class Number>
constexpr Number fused_cross(const BasicVector<Number>& a, const BasicVector<Number>& b) {
  return fused_product(a.x, b.y, -(a.y * b.x));
}
/// c - a . b: where that is small nothing but the first product and c less that product are
/// rounded.
template <class Number>
constexpr Number less_dot(const Number& c, const BasicVector<Number>& a,
                          const BasicVector<Number>& b) {
  return fused_product(-a.y, b.y, fused_product(-a.x, b.x, c));
}

/// The point x less n a + m b: a start seen from another cell of a lattice. Rounded twice: by u(|x|
/// + |m b|) and u of the result.
template <class Number>
constexpr BasicVector<Number> less_multiples(const BasicVector<Number>& x, const Number& n,
                                             const BasicVector<Number>& a, const Number& m,
                                             const BasicVector<Number>& b) {
  return {fused_product(-n, a.x, fused_product(-m, b.x, x.x)),
          fused_product(-n, a.y, fused_product(-m, b.y, x.y))};
}

/// a kappa^2 + 2 b kappa + c.
template <class Number>
struct Quadratic {
  Number a{}, b{}, c{};
  friend constexpr Quadratic operator-(const Quadratic& q) { return {-q.a, -q.b, -q.c}; }
};
/// b^2 - a c.
template <class Number>
constexpr Number discriminant_of(const Quadratic<Number>& q) {
  return fused_product(-q.a, q.c, q.b * q.b);
}

/// Twice the oriented distance, up to the factor |v|, of the point P + d from the flight: positive
/// on its left, negative on its right. Larmor circle: its sign times that of omega is positive
/// outside for omega > 0 (the clockwise circle is on the flight's right) and inside for omega < 0.
template <class Number>
constexpr Number side_of_flight(const BasicVector<Number>& v, const BasicVector<Number>& d,
                                const Number& omega) {
  return Number(2) * cross(v, d) + omega * dot(d, d);
}

/// The centre of the Larmor circle of a clockwise flight, omega > 0, seen from J and times omega; e
/// = P - J. J lies inside if its square is below |v|^2.
template <class Number>
constexpr BasicVector<Number> centre_of_circle(const BasicVector<Number>& e,
                                               const BasicVector<Number>& v, const Number& omega) {
  return {omega * e.x + v.y, omega * e.y - v.x};
}

/// Flight against the line through A along d, domain on the left; e = P - A. `half` is 1/2.
template <class Number>
constexpr Quadratic<Number> line_quadratic(const BasicVector<Number>& e,
                                           const BasicVector<Number>& d,
                                           const BasicVector<Number>& v, const Number& omega,
                                           const Number& half) {
  const Number a = fused_cross(d, e);
  const Number h = half * omega;
  return {a, half * fused_cross(d, v), a * (h * h) - h * dot(d, v)};
}

/// Flight against the circle of squared radius r2 about C, domain outside; e = P - C, v2 = |v|^2.
template <class Number>
constexpr Quadratic<Number> circle_quadratic(const BasicVector<Number>& e, const Number& r2,
                                             const BasicVector<Number>& v, const Number& v2,
                                             const Number& omega, const Number& half) {
  const Number a = dot(e, e) - r2;
  const Number h = half * omega;
  return {a, dot(e, v), a * (h * h) + omega * cross(e, v) + v2};
}

/// The same without field.
template <class Number>
constexpr Quadratic<Number> circle_quadratic(const BasicVector<Number>& e, const Number& r2,
                                             const BasicVector<Number>& v, const Number& v2) {
  return {-less_dot(r2, e, e), fused_dot(e, v), v2};
}

/// Flight without field against an ellipse about C, domain outside, by the form that is 1 on it; e
/// = P - C, `axis` a unit vector along one of its axes. The weights (squares of the inverse
/// semi-axes) come after the products: a rounded factor on each coordinate would bias every flight
/// the same way.
template <class Number>
constexpr Quadratic<Number> ellipse_quadratic(const BasicVector<Number>& e,
                                              const BasicVector<Number>& v,
                                              const BasicVector<Number>& axis, const Number& along,
                                              const Number& across) {
  const BasicVector<Number> other = left(axis);
  const BasicVector<Number> em{fused_dot(axis, e), fused_dot(other, e)},
      vm{fused_dot(axis, v), fused_dot(other, v)};
  return {fused_product(across, em.y * em.y, fused_product(along, em.x * em.x, Number(-1))),
          fused_product(across, em.y * vm.y, along * (em.x * vm.x)),
          fused_product(across, vm.y * vm.y, along * (vm.x * vm.x))};
}

/// Coefficients of kappa^0 … kappa^4.
template <class Number>
struct Quartic {
  Number q[5]{};
};

/// Larmor flight against an ellipse in the frame in which it is a circle of squared radius r2,
/// domain outside: e, v and w are the images of P - C, of v and of J v.
template <class Number>
constexpr Quartic<Number> ellipse_quartic(const BasicVector<Number>& e, const Number& r2,
                                          const BasicVector<Number>& v,
                                          const BasicVector<Number>& w, const Number& omega,
                                          const Number& half) {
  const Number h = dot(e, e) - r2;
  const Number n = (half * omega) * (half * omega);
  const Number ev = dot(e, v);
  const Number ew = omega * dot(e, w);
  return {{n * (n * h + ew + dot(w, w)), Number(2) * n * ev + omega * dot(v, w),
           Number(2) * n * h + ew + dot(v, v), Number(2) * ev, h}};
}

/// kappa/N and (omega/2)/N. Divisions, not products with 1/N: numbers that come out even stay
/// exact.
template <class Number>
struct FlightFactors {
  Number along{}, across{};
};
template <class Number>
constexpr FlightFactors<Number> flight_factors(const Number& kappa, const Number& omega,
                                               const Number& half) {
  const Number h = half * omega;
  const Number n = kappa * kappa + h * h;
  return {kappa / n, h / n};
}
/// Displacement x - P.
template <class Number>
constexpr BasicVector<Number> displacement(const FlightFactors<Number>& f,
                                           const BasicVector<Number>& v) {
  return {f.along * v.x + f.across * v.y, f.along * v.y - f.across * v.x};
}
/// The vector v turned clockwise by an angle: its sine, and 1 less its cosine. The velocity there:
/// omega f.along and omega f.across.
template <class Number>
constexpr BasicVector<Number> turned_by(const Number& sine, const Number& less,
                                        const BasicVector<Number>& v) {
  return {v.x + (sine * v.y - less * v.x), v.y - (sine * v.x + less * v.y)};
}
template <class Number>
constexpr BasicVector<Number> displacement(const Number& kappa, const BasicVector<Number>& v,
                                           const Number& omega, const Number& half) {
  return displacement(flight_factors(kappa, omega, half), v);
}

/// One Newton step of 1/sqrt: what is to be added to d, as a fraction of it, where weight d.d
/// should be 1/2. The first product is taken from 1/2, where doubles below it are evenly spaced,
/// and what is left of it by the second one is rounded as a small number: so the step has no bias.
/// (Squares rounded about a power of two have one, and angular momentum or energy would drift.)
template <class Number>
constexpr Number step_of_length(const BasicVector<Number>& weighted, const BasicVector<Number>& d) {
  return less_dot(Number(0.5), weighted, d);
}
/// What is to be added, as a multiple of a unit normal, to a point on a line up to rounding; d
/// leads to it from another one there.
template <class Number>
constexpr Number step_to_line(const BasicVector<Number>& d, const BasicVector<Number>& normal) {
  return less_dot(Number(0), normal, d);
}
/// The point x moved by `step` times a vector: a flight of that duration; and how every hit is put
/// on its wall, along a segment's normal or a conic's x - centre.
template <class Number>
constexpr BasicVector<Number> moved(const BasicVector<Number>& x, const Number& step,
                                    const BasicVector<Number>& way) {
  return {fused_product(step, way.x, x.x), fused_product(step, way.y, x.y)};
}
/// A vector longer by the fraction `step`.
template <class Number>
constexpr BasicVector<Number> lengthened(const BasicVector<Number>& d, const Number& step) {
  return moved(d, step, d);
}
/// The squared speed V that a particle keeps: weight = 1/(2V), rounded, and what is left of weight
/// V above 1/2. Flight times are taken from V itself: were the shell's speed another one, if only
/// by its last digit, each hit would lie beyond its wall by as much, and angular momentum would
/// drift.
template <class Number>
struct EnergyShell {
  Number weight{0.5}, rest{};
};
/// The step for which the velocity v has the right speed. It is taken from the velocity before a
/// reflection, so that no hit waits for it; what one reflection errs, the next one mends.
template <class Number>
constexpr Number step_to_energy_shell(const BasicVector<Number>& v,
                                      const EnergyShell<Number>& shell) {
  return step_of_length(shell.weight * v, v) + shell.rest;
}

/// A point on an ellipse up to rounding, d seen from its centre, under the axes that map the
/// ellipse to the unit circle: its image, the gradient of half the form there, and the step that
/// brings it back.
template <class Number>
struct OnEllipse {
  BasicVector<Number> image, gradient;
  Number step{};
};
template <class Number>
constexpr OnEllipse<Number> on_ellipse(const BasicVector<Number>& d,
                                       const BasicVector<Number>& first,
                                       const BasicVector<Number>& second) {
  const BasicVector<Number> image{fused_dot(first, d), fused_dot(second, d)};
  return {image, moved(image.x * first, image.y, second),
          step_of_length(Number(0.5) * image, image)};
}

/// 2 (v.n)/|n|^2 for n2 = k |n|^2: how much of the normal n a reflection takes from v.
template <class Number>
constexpr Number reflection_factor(const BasicVector<Number>& v, const BasicVector<Number>& n,
                                   const Number& n2, const Number& k) {
  return Number(2) * k * fused_dot(v, n) / n2;
}
/// The same for a circle, n = d from its centre and `step` its step_of_length, without a division:
/// 2/|d|^2 is `strength` (1 + 2 step) except for the square of 2 step, where strength is 2/r^2 of
/// the r of its weight to the last digit.
template <class Number>
constexpr Number reflection_factor_on_circle(const BasicVector<Number>& v,
                                             const BasicVector<Number>& d, const Number& strength,
                                             const Number& step) {
  const Number factor = strength * fused_dot(v, d);
  return fused_product(step + step, factor, factor);
}
/// Up to this step: 1/(1 - 2 step) differs from 1 + 2 step by (2 step)^2 <= 2^-54, half a unit of
/// rounding, and the point after it from the circle by 3/2 step^2 of the radius, less still. Beyond
/// lie hits on circles much smaller than the distances that particles come from.
inline constexpr double longest_step = 0x1p-28;
/// Velocity after a reflection by a wall with normal n, lengthened by the fraction `step`.
template <class Number>
constexpr BasicVector<Number> reflected(const BasicVector<Number>& v, const BasicVector<Number>& n,
                                        const Number& factor, const Number& step) {
  return lengthened(moved(v, -factor, n), step);
}
template <class Number>
constexpr BasicVector<Number> reflected(const BasicVector<Number>& v, const BasicVector<Number>& n,
                                        const Number& n2, const Number& k, const Number& step) {
  return reflected(v, n, reflection_factor(v, n, n2, k), step);
}

}  // namespace carom::geometry
