#include "forces/formula_bound.hpp"

#include <array>
#include <vector>

#include "forces/formula.hpp"

namespace carom::forces {
namespace {

using complex_box::Box;
using complex_box::Range;
using formula::Instruction;
using formula::Operation;

/// A value and its derivatives, and whether pieces of the formula meet within the box.
template <std::size_t n>
struct Enclosed {
  Box v;
  std::array<Box, n> d;
};

template <std::size_t n>
class Evaluation {
 public:
  using Number = Enclosed<n>;

  explicit Evaluation(const TypedExpression::Formula& f) : formula_(f) {}
  Number run(const std::array<Box, n>& at) {
    kinked = false;
    slots_.assign(formula_.variables + formula_.instructions.size(), {});
    for (std::size_t k = 0; k < n; ++k) {
      slots_[k].v = at[k];
      slots_[k].d[k] = Box(1.0);
    }
    for (std::size_t k = 0; k < formula_.instructions.size(); ++k)
      slots_[formula_.variables + k] = apply(formula_.instructions[k]);
    return slots_[formula_.result];
  }
  bool kinked = false;

 private:
  static Number chain(const Box& value, const Box& slope, const Number& a) {
    Number out;
    out.v = value;
    for (std::size_t k = 0; k < n; ++k) out.d[k] = slope * a.d[k];
    return out;
  }
  static Number chain(const Box& value, const Box& slope_a, const Number& a, const Box& slope_b,
                      const Number& b) {
    Number out;
    out.v = value;
    for (std::size_t k = 0; k < n; ++k) out.d[k] = slope_a * a.d[k] + slope_b * b.d[k];
    return out;
  }
  Number either(const Number& a, const Number& b) {
    kinked = true;
    Number out;
    out.v = hull(a.v, b.v);
    for (std::size_t k = 0; k < n; ++k) out.d[k] = hull(a.d[k], b.d[k]);
    return out;
  }
  static Number power_of(const Number& a, const Box& exponent) {
    if (is_cut(a.v)) return chain(Box::all(), Box::all(), a);
    const Box value = exponential(exponent * logarithm(a.v));
    return chain(value, exponent * (value * inverse(a.v)), a);
  }
  const Instruction* made_by(std::uint16_t slot) const {
    return slot < formula_.variables ? nullptr : &formula_.instructions[slot - formula_.variables];
  }
  /// The slots of a and b where a slot holds a^2 + b^2; a root of it is a distance, whose slopes
  /// are at most 1.
  bool is_square_of_distance(std::uint16_t slot, std::uint16_t& a, std::uint16_t& b) const {
    const Instruction* sum = made_by(slot);
    if (!sum || sum->operation != Operation::sum) return false;
    const auto base = [&](std::uint16_t part, std::uint16_t& of) {
      const Instruction* i = made_by(part);
      if (!i) return false;
      of = i->a;
      return (i->operation == Operation::whole_power && i->n == 2) ||
             (i->operation == Operation::product && i->a == i->b);
    };
    return base(sum->a, a) && base(sum->b, b);
  }
  Number root_of(const Instruction& i, const Number& a) {
    if (!is_cut(a.v)) {
      const Box value = root(a.v);
      return chain(value, Box(0.5) * inverse(value), a);
    }
    std::uint16_t first = 0, second = 0;
    if (!is_square_of_distance(i.a, first, second)) return chain(Box::all(), Box::all(), a);
    kinked = true;
    const Box slope({-1.0, 1.0}, {0.0, 0.0});
    return chain(complex_box::disc(std::sqrt(complex_box::size(a.v))), slope, slots_[first], slope,
                 slots_[second]);
  }

  Number apply(const Instruction& i) {
    const Number& a = slots_[i.a];
    const Number& b = slots_[i.b];
    switch (i.operation) {
      case Operation::number: {
        Number out;
        out.v = Box(i.c);
        return out;
      }
      case Operation::negative:
        return chain(-a.v, Box(-1.0), a);
      case Operation::sum:
        return chain(a.v + b.v, Box(1.0), a, Box(1.0), b);
      case Operation::shifted:
        return chain(a.v + Box(i.c), Box(1.0), a);
      case Operation::difference:
        return chain(a.v - b.v, Box(1.0), a, Box(-1.0), b);
      case Operation::number_minus:
        return chain(Box(i.c) - a.v, Box(-1.0), a);
      case Operation::product:
        if (i.a == i.b) return chain(square(a.v), Box(2.0) * a.v, a);
        return chain(a.v * b.v, b.v, a, a.v, b);
      case Operation::multiple:
        return chain(Box(i.c) * a.v, Box(i.c), a);
      case Operation::quotient: {
        const Box over = inverse(b.v), value = a.v * over;
        return chain(value, over, a, -(value * over), b);
      }
      case Operation::share:
        return chain(a.v * Box(1.0 / i.c), Box(1.0 / i.c), a);
      case Operation::number_over: {
        const Box over = inverse(a.v);
        return chain(Box(i.c) * over, Box(-i.c) * square(over), a);
      }
      case Operation::whole_power:
        return chain(power(a.v, i.n), Box(i.n) * (i.n == 2 ? a.v : power(a.v, i.n - 1)), a);
      case Operation::half_power:
      case Operation::real_power: {
        if (const double c = i.operation == Operation::half_power ? i.n + 0.5 : i.c;
            !is_cut(a.v) || c < 1.0)
          return power_of(a, Box(c));
        else {
          // A power above 1 of what reaches 0: bounded, with a branch there.
          kinked = kinked || c < 2.0;
          const double m = complex_box::size(a.v),
                       above = elementary::exp((c - 1.0) * elementary::log(m));
          return chain(complex_box::disc(above * m), complex_box::disc(c * above), a);
        }
      }
      case Operation::power: {
        if (is_cut(a.v)) return chain(Box::all(), Box::all(), a, Box::all(), b);
        const Box logarithm_a = logarithm(a.v), value = exponential(b.v * logarithm_a);
        return chain(value, b.v * (value * inverse(a.v)), a, value * logarithm_a, b);
      }
      case Operation::root:
        return root_of(i, a);
      case Operation::exp: {
        const Box value = exponential(a.v);
        return chain(value, value, a);
      }
      case Operation::log:
        if (is_cut(a.v)) return chain(Box::all(), Box::all(), a);
        return chain(logarithm(a.v), inverse(a.v), a);
      case Operation::sin:
        return chain(sine(a.v), cosine(a.v), a);
      case Operation::cos:
        return chain(cosine(a.v), -sine(a.v), a);
      case Operation::tan: {
        const Box over = inverse(cosine(a.v));
        return chain(sine(a.v) * over, square(over), a);
      }
      case Operation::sinh:
        return chain(hyperbolic_sine(a.v), hyperbolic_cosine(a.v), a);
      case Operation::cosh:
        return chain(hyperbolic_cosine(a.v), hyperbolic_sine(a.v), a);
      case Operation::tanh: {
        const Box value = hyperbolic_tangent(a.v), by_value = Box(1.0) - square(value);
        const Box by_cosine = inverse(square(hyperbolic_cosine(a.v)));
        return chain(
            value,
            complex_box::size(by_cosine) < complex_box::size(by_value) ? by_cosine : by_value, a);
      }
      case Operation::abs:
        if (a.v.re.low > 0.0) return a;
        if (a.v.re.high < 0.0) return chain(-a.v, Box(-1.0), a);
        return either(a, chain(-a.v, Box(-1.0), a));
      case Operation::atan2: {
        const Box over = inverse(square(a.v) + square(b.v));
        // Beyond the real plane the angle is that of the real point, displaced by the path to it.
        const Box slope_a = b.v * over, slope_b = -(a.v * over);
        const double away = complex_box::size(slope_a) * complex_box::largest(a.v.im) +
                            complex_box::size(slope_b) * complex_box::largest(b.v.im);
        const Range off{-away, away};
        return chain(Box(complex_box::argument({b.v.re, a.v.re}) + off, off), slope_a, a, slope_b,
                     b);
      }
      case Operation::least:
      case Operation::greatest: {
        const bool least = i.operation == Operation::least;
        if (a.v.re.high < b.v.re.low) return least ? a : b;
        if (b.v.re.high < a.v.re.low) return least ? b : a;
        return either(a, b);
      }
    }
    return {};
  }

  const TypedExpression::Formula& formula_;
  std::vector<Number> slots_;
};

double bounded(double x) { return x < complex_box::unbounded ? x : complex_box::unbounded; }

/// The size of a force (-d0, -d1), as forces/force_bound.hpp measures it.
double size_of(const Box& x, const Box& y) {
  const Box turned(-y.im, y.re);  // i y
  return bounded(std::max(complex_box::size(x + turned), complex_box::size(x - turned)));
}
double width(Range a) { return a.high - a.low; }

}  // namespace

ForceBound bound_of(const TypedExpression& v, const Neighbourhood& n) {
  Evaluation<2> evaluation(v.formula());
  const Range off{-n.rho, n.rho};
  const Range x = Range{n.low.x, n.high.x} + off, y = Range{n.low.y, n.high.y} + off;
  const Enclosed<2> near = evaluation.run({Box(x, off), Box(y, off)});
  ForceBound bound{size_of(near.d[0], near.d[1]), 0.0};
  if (!evaluation.kinked) return bound;
  // The pieces differ by no more than the real force does over the real neighbourhood.
  const Enclosed<2> real = evaluation.run({Box(x, {}), Box(y, {})});
  const double jump_x = width(real.d[0].re), jump_y = width(real.d[1].re);
  bound.jump = bounded(std::sqrt(jump_x * jump_x + jump_y * jump_y));
  return bound;
}

ValuesOverBox values_over(const TypedExpression& f, const geometry::Box& box) {
  Evaluation<2> evaluation(f.formula());
  const Enclosed<2> all =
      evaluation.run({Box({box.low.x, box.high.x}, {}), Box({box.low.y, box.high.y}, {})});
  if (evaluation.kinked)
    return {complex_box::everything, complex_box::everything, complex_box::everything};
  return {all.v.re, all.d[0].re, all.d[1].re};
}

ForceBound bound_of(const TypedExpression& w, double distance, double rho) {
  if (!(rho < distance)) return {complex_box::unbounded, 0.0};
  Evaluation<1> evaluation(w.formula());
  const Range off{-rho, rho}, r = Range{distance, distance} + off;
  const double ratio = std::sqrt((distance + rho) / (distance - rho));  // of |p|/|sqrt(p q)|
  ForceBound bound{bounded(ratio * complex_box::size(evaluation.run({Box(r, off)}).d[0])), 0.0};
  if (evaluation.kinked) bound.jump = bounded(width(evaluation.run({Box(r, {})}).d[0].re));
  return bound;
}

}  // namespace carom::forces
