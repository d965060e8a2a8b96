// From u to the point and back: the one sequence of operations that every engine uses, so that u is
// the same function of a state in all of them. A frame holds what is needed of a curve, each number
// rounded once from its exact value.
//
// A conic is run through as  centre + X a + Y b,  X = (1 - w^2)/(1 + w^2), Y = 2w/(1 + w^2)  in its
// first quarter; a further quarter turns (a, b) into (b, -a). Back, X and Y are linear in the
// point. Arcs are measured from their start, not from their centre: a flat arc has its centre far
// away, and everything that is rounded there is as large as the radius.
//
// No container and no function of the standard library here: lanes instantiate these templates.
#pragma once

#include "carom/geometry/vector.hpp"

namespace carom::geometry {

/// What the map from the parameter u to a point and back needs of a curve, in one kind of number.
template <class Number>
struct Frame {
  BasicVector<Number> origin;  ///< start of a segment or arc; centre of a closed curve
  BasicVector<Number> a, b;    ///< start - centre and its quarter turn; segment: a = to - from
  BasicVector<Number> along,
      across;            ///< X = start + along . (P - origin), Y = across . (P - origin)
  Number start{};        ///< 1 for arcs, 0 for closed curves
  Number end{}, last{};  ///< end_parameter, last_parameter
};

namespace detail {

template <class Number>
constexpr Number choose(bool condition, const Number& yes, const Number& no) {
  return condition ? yes : no;
}
/// Lanes: `where` is found beside their type.
template <class Mask, class Number>
constexpr Number choose(const Mask& condition, const Number& yes, const Number& no) {
  Number result = no;
  where(condition, result) = yes;
  return result;
}

/// The direction that X and Y have at the start of the quarter with number n.
template <class Number>
constexpr BasicVector<Number> quarter_turn(const Number& n) {
  const Number zero(0), one(1);
  const Number x = choose(n == zero, one, choose(n == Number(2), -one, zero));
  const Number y = choose(n == one, one, choose(n == Number(3), -one, zero));
  return {x, y};
}

template <class Number>
constexpr Number quarter_number(const Number& u) {
  const Number zero(0), one(1), two(2), three(3);
  return choose(u < two, choose(u < one, zero, one), choose(u < three, two, three));
}

/// The quarter of a conic in which (X, Y) lies, by signs alone, with the direction of its start.
template <class Number>
struct Quarter {
  Number n;
  BasicVector<Number> start;
};
template <class Number>
constexpr Quarter<Number> quarter_of(const Number& x, const Number& y) {
  const Number zero(0), one(1), two(2), three(3);
  const auto front = x > zero;
  const auto back = x < zero;
  const auto ahead = (y > zero) || ((y == zero) && front);
  const Number n = choose(ahead, choose(front, zero, one), choose(back, two, three));
  return {n, quarter_turn(n)};
}
inline constexpr Quarter<double> quarters[] = {
    {0, {1, 0}}, {1, {0, 1}}, {2, {-1, 0}}, {3, {0, -1}}};
/// The same by looking it up: a processor cannot guess the quarter.
constexpr const Quarter<double>& quarter_of(const double& x, const double& y) {
  const unsigned front = x > 0.0, back = x < 0.0;
  const unsigned ahead = static_cast<unsigned>(y > 0.0) | (static_cast<unsigned>(y == 0.0) & front);
  return quarters[3 - 2 * ahead - (ahead & front) - (~ahead & back)];
}

}  // namespace detail

/// Point of a segment.
template <class Number>
constexpr BasicVector<Number> segment_point(const Frame<Number>& f, const Number& u) {
  return f.origin + u * f.a;
}

/// Point of a conic. Written as a displacement from the start of the quarter, 2w (b - w a)/(1 +
/// w^2), which is small with w. With U = 2^-53 and one coordinate at a time: w^2, 1 + w^2 and the
/// quotient cost 3U, b and w a as stored and rounded and their difference 3U, the product U; the
/// start of a further quarter, a sum of two stored numbers, 2U; the last two sums U of the result
/// and of the displacement. Together: error <= U |result| + 10 U (|a| + |b|), the latter times
/// min(1, 2w) in the first quarter.
template <class Number>
constexpr BasicVector<Number> conic_point(const Frame<Number>& f, const Number& u) {
  const Number one(1);
  const Number n = detail::quarter_number(u);
  const Number w = u - n;
  const BasicVector<Number> q = detail::quarter_turn(n);
  const BasicVector<Number> from = (q.x - f.start) * f.a + q.y * f.b;
  const BasicVector<Number> a = q.x * f.a + q.y * f.b;
  const BasicVector<Number> b = q.x * f.b - q.y * f.a;
  const Number chord = (w + w) / (one + w * w);
  return f.origin + (from + chord * (b - w * a));
}

/// A vector along the tangent of a conic in the direction of travel: of length r for a circle, the
/// derivative by the eccentric angle for an ellipse.
template <class Number>
constexpr BasicVector<Number> conic_direction(const Frame<Number>& f, const Number& u) {
  const Number one(1);
  const Number n = detail::quarter_number(u);
  const Number w = u - n;
  const BasicVector<Number> q = detail::quarter_turn(n);
  const BasicVector<Number> a = q.x * f.a + q.y * f.b;
  const BasicVector<Number> b = q.x * f.b - q.y * f.a;
  const Number weight = one + w * w;
  const Number x = (one - w) * (one + w) / weight, y = (w + w) / weight;
  return x * b - y * a;
}

/// Parameter of a point on the line of a segment.
template <class Number>
constexpr Number line_parameter(const Frame<Number>& f, const BasicVector<Number>& point) {
  return dot(f.along, point - f.origin);
}
/// Parameter of a point on a segment, clamped to [first, f.last].
template <class Number>
constexpr Number segment_parameter(const Frame<Number>& f, const BasicVector<Number>& point,
                                   const Number& first) {
  const Number u = line_parameter(f, point);
  return detail::choose(u < first, first, detail::choose(u > f.last, f.last, u));
}

/// Parameter of a point on a conic, clamped to [first, f.last]: beyond the end, to whichever end is
/// nearer. The quarter is chosen by signs alone.
template <class Number>
constexpr Number conic_parameter(const Frame<Number>& f, const BasicVector<Number>& point,
                                 const Number& first) {
  const Number one(1), four(4);
  const BasicVector<Number> e = point - f.origin;
  const Number x = f.start + dot(f.along, e);
  const Number y = dot(f.across, e);
  const auto& [n, q] = detail::quarter_of(x, y);
  const Number along = q.x * x + q.y * y;
  const Number across = q.x * y - q.y * x;
  const Number u = n + across / (one + along);
  const Number beyond = detail::choose(u - f.end > four - u, first, f.last);
  return detail::choose(u < first, first, detail::choose(u > f.last, beyond, u));
}

}  // namespace carom::geometry
