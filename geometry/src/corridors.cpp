// Projections of the obstacles across a lattice vector p are intervals [a - sqrt(d), a + sqrt(d)]
// in units of 1/|p|: with the numbers of the table also a and d are dyadic, and the period is the
// area of the cell, whatever p is.
#include "carom/geometry/corridors.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "carom/geometry/hull.hpp"
#include "dyadic.hpp"

namespace carom::geometry {

namespace {

using Exact = BasicVector<Dyadic>;

// Directions looked at, at most, and projections of walls onto them: each costs some microseconds.
constexpr std::size_t most_directions = 20000, most_projections = 200000;

Exact exact(Vector v) { return {Dyadic(v.x), Dyadic(v.y)}; }

// a + sign sqrt(d)
struct End {
  Dyadic a, d;
  int side;
};
End shifted(const End& e, const Dyadic& by) { return {e.a + by, e.d, e.side}; }

int order(const End& x, const End& y) {
  return sign_with_two_roots(x.a - y.a, Dyadic(x.side), x.d, Dyadic(-y.side), y.d);
}

struct Interval {
  End low, high;
};

Interval about(const Dyadic& middle, const Dyadic& square) {
  return {{middle, square, -1}, {middle, square, 1}};
}

Interval between(const Dyadic& one, const Dyadic& other) {
  const bool ordered = (other - one).sign() >= 0;
  const Dyadic zero;
  return {{ordered ? one : other, zero, -1}, {ordered ? other : one, zero, 1}};
}

// Does the arc hold the farthest point of its circle in direction d, that is, does d come after
// `from` and before `to` on the way counter-clockwise? All as seen from the centre.
bool within(const Exact& from, const Exact& to, const Exact& d) {
  const int whole = cross(from, to).sign(), first = cross(from, d).sign(),
            second = cross(d, to).sign();
  if (whole > 0) return first > 0 && second > 0;
  if (whole < 0) return first > 0 || second > 0;
  // Half a circle.
  return first > 0;
}

// Projection onto x -> cross(p, x); none for arcs of ellipses and Bézier curves.
std::optional<Interval> projection(const Curve& curve, const Exact& p) {
  if (const auto* segment = std::get_if<Segment>(&curve))
    return between(cross(p, exact(segment->from)), cross(p, exact(segment->to)));
  if (const auto* circle = std::get_if<Circle>(&curve)) {
    const Dyadic r(circle->radius);
    return about(cross(p, exact(circle->centre)), r * r * dot(p, p));
  }
  if (const auto* ellipse = std::get_if<Ellipse>(&curve)) {
    const Exact axis = exact(ellipse->axis);
    const Dyadic along = cross(p, axis), across = Dyadic(ellipse->ratio) * cross(p, left(axis));
    return about(cross(p, exact(ellipse->centre)), along * along + across * across);
  }
  if (const auto* arc = std::get_if<CircularArc>(&curve)) {
    const Exact from = exact(arc->from), to = exact(arc->to);
    const Exact centre = Dyadic(0.5) * (from + to) + Dyadic(arc->offset) * left(to - from);
    const Exact a = from - centre, b = to - centre;
    Interval result = between(cross(p, from), cross(p, to));
    const Dyadic middle = cross(p, centre), square = dot(a, a) * dot(p, p);
    const Exact& first = arc->counterclockwise ? a : b;
    const Exact& last = arc->counterclockwise ? b : a;
    // cross(p, x) grows fastest along left(p).
    if (within(first, last, left(p))) result.high = {middle, square, 1};
    if (within(first, last, -left(p))) result.low = {middle, square, -1};
    return result;
  }
  return std::nullopt;
}

// A lower bound of the width of a convex body with the given area and diameter is their quotient.
double least_width(const std::vector<Curve>& walls) {
  double width = 0.0;
  for (std::size_t first = 0; first < walls.size();) {
    if (const auto* circle = std::get_if<Circle>(&walls[first]))
      width = std::max(width, 2.0 * circle->radius);
    double area = 0.0;
    Box box = bounding_box(walls[first]);
    std::size_t next = first;
    do {
      box = hull(box, bounding_box(walls[next]));
      area += area_integral(walls[next]);
      ++next;
    } while (next < walls.size() && !is_closed(walls[next - 1]) &&
             !(end_point(walls[next - 1]) == start_point(walls[first])));
    const Vector diagonal = box.high - box.low;
    width = std::max(width, std::fabs(area) / std::sqrt(dot(diagonal, diagonal)));
    first = next;
  }
  return width;
}

struct Direction {
  Cell cell;
  double square;
};

// One of each pair of opposite primitive vectors not longer than `longest`, shortest first.
std::vector<Direction> directions(const Lattice& lattice, double longest, std::size_t walls,
                                  bool& complete) {
  const double most =
      static_cast<double>(std::clamp<std::size_t>(most_projections / walls, 1, most_directions));
  const double area = lattice.cell_area();
  const double a = std::sqrt(dot(lattice.first, lattice.first));
  const double b = std::sqrt(dot(lattice.second, lattice.second));
  std::vector<Direction> result;
  // |m| = |cross(p, second)| / area and |n| = |cross(first, p)| / area.
  double most_first = std::floor(longest * b / area + 1.0),
         most_second = std::floor(longest * a / area + 1.0);
  // Twice or more where one of the numbers has come down to its least, 1.
  while ((most_first + 1) * (2 * most_second + 1) > std::max(most, 6.0)) {
    complete = false;
    longest *= std::sqrt(most / ((most_first + 1) * (2 * most_second + 1)));
    most_first = std::floor(longest * b / area + 1.0);
    most_second = std::floor(longest * a / area + 1.0);
  }
  for (std::int64_t m = 0; m <= static_cast<std::int64_t>(most_first); ++m) {
    for (auto n = -static_cast<std::int64_t>(most_second);
         n <= static_cast<std::int64_t>(most_second); ++n) {
      if (std::gcd(m, n) != 1 || (m == 0 && n != 1)) continue;
      const Vector p = lattice.translation({m, n});
      if (dot(p, p) <= longest * longest) result.push_back({{m, n}, dot(p, p)});
    }
  }
  std::sort(result.begin(), result.end(), [](const Direction& x, const Direction& y) {
    if (x.square != y.square) return x.square < y.square;
    return x.cell.first != y.cell.first ? x.cell.first < y.cell.first
                                        : x.cell.second < y.cell.second;
  });
  return result;
}

// (high - low) / |p|, with more digits than cancel.
double width_of(const End& low, const End& high, const Exact& p) {
  constexpr unsigned bits = 512;
  const auto value = [](const End& e) {
    mpf_class root(e.d.rational(), bits);
    root = sqrt(root);
    return mpf_class(mpf_class(e.a.rational(), bits) + e.side * root, bits);
  };
  const mpf_class length = sqrt(mpf_class(dot(p, p).rational(), bits));
  return mpf_class((value(high) - value(low)) / length, bits).get_d();
}

// Adds the gaps that the intervals leave modulo the period.
void add_gaps(std::vector<Interval>& intervals, const Dyadic& period, const Cell& cell,
              const Exact& p, const Vector& along, std::vector<Corridor>& corridors) {
  const End zero{Dyadic(), Dyadic(), 1};
  for (Interval& i : intervals) {
    // By whole periods until it starts in the first one.
    mpz_class whole;
    const mpq_class turns = i.low.a.rational() / period.rational();
    mpz_fdiv_q(whole.get_mpz_t(), turns.get_num_mpz_t(), turns.get_den_mpz_t());
    const auto move = [&i](const Dyadic& by) { i = {shifted(i.low, by), shifted(i.high, by)}; };
    move(-(Dyadic(whole.get_d()) * period));
    while (order(i.low, zero) < 0) move(period);
    while (order(i.low, {period, Dyadic(), 1}) >= 0) move(-period);
  }
  for (const Interval& i : intervals) {
    if (order(i.high, shifted(i.low, period)) >= 0) return;  // covers all by itself
  }
  std::sort(intervals.begin(), intervals.end(),
            [](const Interval& x, const Interval& y) { return order(x.low, y.low) < 0; });
  End reach = shifted(intervals.front().high, -period);
  for (const Interval& i : intervals) {
    const End before = shifted(i.high, -period);
    if (order(before, reach) > 0) reach = before;
  }
  for (const Interval& i : intervals) {
    if (order(i.low, reach) > 0) corridors.push_back({cell, along, width_of(reach, i.low, p)});
    if (order(i.high, reach) > 0) reach = i.high;
  }
}

}  // namespace

Corridors free_corridors(const Lattice& lattice, const std::vector<Curve>& walls) {
  Corridors result;
  const auto unknown = [](const Curve& c) {
    return std::holds_alternative<EllipticArc>(c) || std::holds_alternative<Bezier>(c);
  };
  result.decided = !walls.empty() && std::none_of(walls.begin(), walls.end(), unknown);
  if (!result.decided) return result;
  const Exact first = exact(lattice.first), second = exact(lattice.second);
  Dyadic period = cross(first, second);
  if (period.sign() < 0) period = -period;
  // One part in 10^3 more than enough: the bound itself is computed in doubles.
  const double longest = 1.001 * lattice.cell_area() / least_width(walls);
  for (const Direction& direction : directions(lattice, longest, walls.size(), result.complete)) {
    const Cell& c = direction.cell;
    const Exact p = Dyadic(static_cast<double>(c.first)) * first +
                    Dyadic(static_cast<double>(c.second)) * second;
    std::vector<Interval> intervals;
    for (const Curve& wall : walls) intervals.push_back(*projection(wall, p));
    add_gaps(intervals, period, c, p, lattice.translation(c), result.list);
  }
  std::stable_sort(result.list.begin(), result.list.end(),
                   [](const Corridor& x, const Corridor& y) { return x.width > y.width; });
  return result;
}

double flight_tail(const Corridors& corridors, double free_area) {
  constexpr double pi = 3.141592653589793;
  double sum = 0.0;
  for (const Corridor& c : corridors.list)
    sum += c.width * c.width * std::sqrt(dot(c.along, c.along));
  return sum / (pi * free_area);
}

}  // namespace carom::geometry
