#include "geometry/oracle.hpp"

// GCC takes CGAL's reference counting for a use after free.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wuse-after-free"
#endif

#include <CGAL/Algebraic_kernel_d_1.h>
#include <CGAL/CORE_BigInt.h>
#include <CGAL/Exact_circular_kernel_2.h>
#include <gmpxx.h>

#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "geometry/one_of.hpp"

namespace carom::tests {

namespace {

using namespace geometry;
using Kernel = CGAL::Exact_circular_kernel_2;
using Root = Kernel::Root_of_2;
using Algebra = CGAL::Algebraic_kernel_d_1<CORE::BigInt>;
using Rational = BasicVector<mpq_class>;

Rational rational(Vector v) { return {mpq_class(v.x), mpq_class(v.y)}; }
Kernel::FT number(const mpq_class& q) { return Kernel::FT(q.get_mpq_t()); }
Kernel::Point_2 point_of(const Rational& p) { return {number(p.x), number(p.y)}; }
CORE::BigInt big(const mpz_class& z) { return CORE::BigInt(z.get_str()); }

/// A conic: centre + ((1 - t^2) a + 2 t b)/(1 + t^2) while t grows from 0 over infinity to 0; a
/// piece of it ends at t = end (0: never).
struct Shape {
  bool segment = false, circle = false, closed = false;
  Rational from, to, centre, a, b;
};

struct Shaper {
  Shape operator()(const Segment& s) const {
    Shape c;
    c.segment = true;
    c.from = rational(s.from);
    c.to = rational(s.to);
    return c;
  }
  Shape operator()(const CircularArc& s) const {
    const Rational from = rational(s.from), to = rational(s.to);
    const mpq_class half(1, 2), offset(s.offset);
    const Rational chord = to - from;
    return conic(from, to, half * (from + to) + offset * left(chord), 1, 0, 1, s.counterclockwise,
                 true);
  }
  Shape operator()(const EllipticArc& s) const {
    const Rational from = rational(s.from), to = rational(s.to), p = rational(s.axis);
    const mpq_class half(1, 2), offset(s.offset), k(s.ratio);
    const Rational e = to - from, q = left(p);
    const mpq_class eq = -dot(e, q), ep = k * k * dot(e, p);
    const Rational turned = eq * p + ep * q;
    return conic(from, to, half * (from + to) + offset * turned, p.x, p.y, k, s.counterclockwise,
                 false);
  }
  Shape operator()(const Circle& s) const {
    const Rational centre = rational(s.centre), radius{mpq_class(s.radius), 0};
    Shape c = conic(centre + radius, centre + radius, centre, 1, 0, 1, s.counterclockwise, true);
    c.closed = true;
    return c;
  }
  Shape operator()(const geometry::Bezier&) const {
    throw std::logic_error("a Bézier curve: see bezier_test.cpp");
  }
  Shape operator()(const Ellipse& s) const {
    const Rational centre = rational(s.centre), axis = rational(s.axis);
    Shape c = conic(centre + axis, centre + axis, centre, axis.x, axis.y, mpq_class(s.ratio),
                    s.counterclockwise, false);
    c.closed = true;
    return c;
  }
  /// b is a, pressed to a circle along the axis p, turned, and drawn out again.
  static Shape conic(const Rational& from, const Rational& to, const Rational& centre,
                     const mpq_class& px, const mpq_class& py, const mpq_class& k,
                     bool counterclockwise, bool circle) {
    Shape c;
    c.circle = circle;
    c.from = from;
    c.to = to;
    c.centre = centre;
    c.a = from - centre;
    const mpq_class p2 = px * px + py * py;
    const mpq_class along = (c.a.x * px + c.a.y * py) / p2, across = (c.a.y * px - c.a.x * py) / p2;
    mpq_class x = -across / k, y = along * k;
    if (!counterclockwise) {
      x = -x;
      y = -y;
    }
    c.b = {x * px - y * py, x * py + y * px};
    return c;
  }
};

mpq_class half_angle(const Shape& c, const Rational& at, bool& infinite) {
  const Rational e = at - c.centre;
  const mpq_class det = cross(c.a, c.b), x = cross(e, c.b) / det, y = cross(c.a, e) / det;
  infinite = x == -1;
  return infinite ? mpq_class(0) : mpq_class(y / (1 + x));
}

Rational conic_at(const Shape& c, const mpq_class& t) {
  const mpq_class n = 1 + t * t, x = (1 - t * t) / n, y = 2 * t / n;
  return c.centre + x * c.a + y * c.b;
}

Rational place(const Shape& c, double u) {
  if (c.segment) return c.from + mpq_class(u) * (c.to - c.from);
  const int quarter = static_cast<int>(u);
  Shape turned = c;
  for (int i = 0; i < quarter; ++i) {
    const Rational a = turned.a;
    turned.a = turned.b;
    turned.b = -a;
  }
  return conic_at(turned, mpq_class(u - quarter));
}

/// alpha x + beta y of a point of the circular kernel: its coordinates share one root.
Root linear(const Kernel::Circular_arc_point_2& at, const mpq_class& alpha, const mpq_class& beta,
            const mpq_class& gamma) {
  const Root x = at.x(), y = at.y();
  if (x.is_extended() && y.is_extended() && x.root() != y.root())
    throw std::logic_error("two roots in one point");
  const auto root = x.is_extended() ? x.root() : y.root();
  const auto a0 = number(alpha) * x.a0() + number(beta) * y.a0() + number(gamma);
  auto a1 = Kernel::FT(0);
  if (x.is_extended()) a1 += number(alpha) * x.a1();
  if (y.is_extended()) a1 += number(beta) * y.a1();
  if (CGAL::is_zero(a1)) return Root(a0);
  return Root(a0, a1, root);
}

/// How far round: the sector, then the cosine. Angles [0, 2 pi).
template <class Value>
struct Turn {
  int sector = 0;  // 0: angle 0, 1: first half, 2: pi, 3: second half
  Value cosine{};
};
template <class Value>
int sign_of(const Value& v) {
  return static_cast<int>(CGAL::sign(v));
}
template <class Value>
Turn<Value> turn_of(const Value& cosine, const Value& sine) {
  const int s = sign_of(sine);
  if (s == 0) return {sign_of(cosine) > 0 ? 0 : 2, cosine};
  return {s > 0 ? 1 : 3, cosine};
}
template <class Value>
int compare(const Turn<Value>& a, const Turn<Value>& b) {
  if (a.sector != b.sector) return a.sector < b.sector ? -1 : 1;
  if (a.sector % 2 == 0) return 0;
  const int order = static_cast<int>(CGAL::compare(a.cosine, b.cosine));
  return a.sector == 1 ? -order : order;
}

constexpr int bits = 800;
mpf_class real(const mpq_class& q) { return mpf_class(q, bits); }
mpq_class rational_of(const Kernel::FT& x) {
  mpq_class q;
  mpq_set(q.get_mpq_t(), x.mpq());
  return q;
}

struct Flying {
  Rational start, v, centre;
  mpq_class omega, r2;
  bool straight = true;
};

/// A point at which the flight passes through a piece.
struct Passage {
  int wall = -1;
  bool joint = false;
  std::optional<Kernel::Circular_arc_point_2> circular;  // else: on an ellipse
  std::optional<Rational> plain;
  mpq_class t;  // on an ellipse, to 2^-900
  Turn<Root> turn;
  int sector = 0;
  mpf_class value;  // along the flight, for ellipses
};

}  // namespace

struct Oracle::Data {
  std::vector<Shape> shapes;
  std::vector<int> next;
  mutable Flying flight;
  mutable std::optional<Passage> found;
  Algebra algebra;

  bool any_ellipse() const {
    for (const Shape& s : shapes)
      if (!s.segment && !s.circle) return true;
    return false;
  }

  bool on_flight(const Rational& p) const {
    const Rational e = p - flight.start;
    if (flight.straight) return cross(e, flight.v) == 0;
    const Rational d = p - flight.centre;
    return dot(d, d) == flight.r2;
  }

  /// Sets the place along the flight; false if it lies behind or is the start.
  bool set_turn(Passage& p) const {
    const Rational& v = flight.v;
    if (flight.straight) {
      if (!p.circular) return true;
      p.turn = {1, -linear(*p.circular, v.x, v.y, -dot(v, flight.start))};
      return sign_of(p.turn.cosine) < 0;
    }
    // From the centre: the start, and a quarter turn on, along v.
    const Rational radius = flight.start - flight.centre;
    p.turn = turn_of(linear(*p.circular, radius.x, radius.y, -dot(radius, flight.centre)),
                     linear(*p.circular, v.x, v.y, -dot(v, flight.centre)));
    return p.turn.sector != 0;
  }

  void add(std::vector<Passage>& all, int wall, bool joint,
           const Kernel::Circular_arc_point_2& at) const {
    Passage p;
    p.wall = wall;
    p.joint = joint;
    p.circular = at;
    if (set_turn(p)) all.push_back(std::move(p));
  }

  /// Strictly between the ends?
  bool between_ends(const Shape& c, const Kernel::Circular_arc_point_2& at, const Rational& from,
                    const Rational& to, bool from_included) const {
    if (c.segment) {
      const Rational d = c.to - c.from;
      const int low = sign_of(linear(at, d.x, d.y, -dot(d, from)));
      return (low > 0 || (from_included && low == 0)) &&
             sign_of(linear(at, d.x, d.y, -dot(d, to))) < 0;
    }
    // Angles from the start of the curve.
    const auto angle = [&](const Kernel::Circular_arc_point_2& x) {
      return turn_of(linear(x, c.a.x, c.a.y, -dot(c.a, c.centre)),
                     linear(x, c.b.x, c.b.y, -dot(c.b, c.centre)));
    };
    const auto x = angle(at);
    const int low = compare(x, angle(Kernel::Circular_arc_point_2(point_of(from))));
    if (low < 0 || (low == 0 && !from_included)) return false;
    if (c.closed && to == c.from) return true;
    return compare(x, angle(Kernel::Circular_arc_point_2(point_of(to)))) < 0;
  }

  void pass(std::vector<Passage>& all, int wall) const {
    const Shape& c = shapes[static_cast<std::size_t>(wall)];
    if (!c.closed && on_flight(c.from))
      add(all, wall, true, Kernel::Circular_arc_point_2(point_of(c.from)));
    if (!c.segment && !c.circle) return pass_ellipse(all, wall);
    std::vector<std::pair<Kernel::Circular_arc_point_2, unsigned>> met;
    const auto meet = [&](const auto& trace, const auto& carrier) {
      using Result = typename CGAL::CK2_Intersection_traits<Kernel, std::decay_t<decltype(trace)>,
                                                            std::decay_t<decltype(carrier)>>::type;
      std::vector<Result> results;
      CGAL::intersection(trace, carrier, std::back_inserter(results));
      for (const Result& r : results)
        if (const auto* p = one_of<std::pair<Kernel::Circular_arc_point_2, unsigned>>(r))
          met.push_back(*p);
    };
    const auto line = [](const Rational& at, const Rational& along) {
      return Kernel::Line_2(point_of(at), point_of(at + along));
    };
    if (c.segment && flight.straight) {
      const auto crossing =
          CGAL::intersection(line(flight.start, flight.v), line(c.from, c.to - c.from));
      if (crossing)
        if (const auto* p = one_of<Kernel::Point_2>(*crossing)) met.emplace_back(*p, 1U);
    } else {
      const Kernel::Line_2 own = c.segment ? line(c.from, c.to - c.from) : Kernel::Line_2();
      const Kernel::Circle_2 round =
          c.segment ? Kernel::Circle_2()
                    : Kernel::Circle_2(point_of(c.centre), number(dot(c.a, c.a)));
      if (flight.straight) {
        meet(line(flight.start, flight.v), round);
      } else {
        const Kernel::Circle_2 orbit(point_of(flight.centre), number(flight.r2));
        if (c.segment)
          meet(own, orbit);
        else
          meet(orbit, round);
      }
    }
    for (const auto& [at, multiplicity] : met)
      if (multiplicity == 1 && (c.closed || between_ends(c, at, c.from, c.to, false)))
        add(all, wall, false, at);
  }

  /// The ellipse's parametrisation put into the equation of the flight: a quartic (line: quadratic)
  /// in t.
  void pass_ellipse(std::vector<Passage>& all, int wall) const {
    const Shape& c = shapes[static_cast<std::size_t>(wall)];
    std::vector<mpq_class> f;
    if (flight.straight) {
      const Rational& v = flight.v;
      const Rational e = c.centre - flight.start;
      f = {cross(v, e) + cross(v, c.a), 2 * cross(v, c.b), cross(v, e) - cross(v, c.a)};
    } else {
      const Rational e = c.centre - flight.centre;
      // (1 + t^2)(e.e - r2) + ..., with X = 1 - t^2, Y = 2t, N = 1 + t^2.
      const mpq_class ee = dot(e, e) - flight.r2, ea = 2 * dot(e, c.a), eb = 2 * dot(e, c.b),
                      aa = dot(c.a, c.a), ab = 2 * dot(c.a, c.b), bb = dot(c.b, c.b);
      f = {ee + ea + aa, 2 * eb + 2 * ab, 2 * ee - 2 * aa + 4 * bb, 2 * eb - 2 * ab, ee - ea + aa};
    }
    mpz_class denominator = 1;
    for (const mpq_class& q : f)
      mpz_lcm(denominator.get_mpz_t(), denominator.get_mpz_t(), q.get_den_mpz_t());
    std::vector<CORE::BigInt> integers;
    for (const mpq_class& q : f)
      integers.push_back(big(mpz_class(q.get_num() * (denominator / q.get_den()))));
    const Algebra::Polynomial_1 polynomial(integers.begin(), integers.end());
    if (polynomial.degree() < 1) return;
    std::vector<std::pair<Algebra::Algebraic_real_1, Algebra::Multiplicity_type>> roots;
    algebra.solve_1_object()(polynomial, std::back_inserter(roots));
    bool never = false, start_never = false;
    const mpq_class end = c.closed ? mpq_class(0) : half_angle(c, c.to, never);
    const mpq_class own = half_angle(c, flight.start, start_never);
    const bool starts = conic_at(c, own) == flight.start && !start_never;
    const auto against = [&](const Algebra::Algebraic_real_1& x, const mpq_class& q) {
      return static_cast<int>(
          algebra.compare_1_object()(x, Algebra::Bound(big(q.get_num()), big(q.get_den()))));
    };
    for (const auto& [t, multiplicity] : roots) {
      if (multiplicity % 2 == 0 || (starts && against(t, own) == 0)) continue;
      const int positive = against(t, mpq_class(0));
      if (!c.closed) {
        if (positive == 0) continue;        // the joint
        const bool far = never || end < 0;  // the end lies in the second half
        if (positive < 0 && !far) continue;
        if (positive > 0 && !far && against(t, end) >= 0) continue;
        if (positive < 0 && (never || against(t, end) >= 0)) continue;
      }
      Passage p;
      p.wall = wall;
      const auto bounds = algebra.approximate_relative_1_object()(t, 900);
      const auto rational_bound = [](const Algebra::Bound& x) {
        std::ostringstream digits;
        digits << x;
        return mpq_class(digits.str());
      };
      p.t = (rational_bound(bounds.first) + rational_bound(bounds.second)) / 2;
      p.plain = conic_at(c, p.t);
      all.push_back(std::move(p));
    }
  }

  /// Place along the flight with 800 bits, for tables with ellipses: false if behind.
  bool set_value(Passage& p) const {
    mpf_class x(0, bits), y(0, bits);
    if (p.circular) {
      const auto coordinate = [](const Root& r) {
        mpf_class value = real(rational_of(r.a0()));
        if (r.is_extended()) value += real(rational_of(r.a1())) * sqrt(real(rational_of(r.root())));
        return value;
      };
      x = coordinate(p.circular->x());
      y = coordinate(p.circular->y());
    } else {
      x = real(p.plain->x);
      y = real(p.plain->y);
    }
    const mpf_class vx = real(flight.v.x), vy = real(flight.v.y);
    if (flight.straight) {
      p.sector = 1;
      p.value = vx * (x - real(flight.start.x)) + vy * (y - real(flight.start.y));
      return sgn(p.value) > 0;
    }
    const mpf_class cx = x - real(flight.centre.x), cy = y - real(flight.centre.y);
    const Rational radius = flight.start - flight.centre;
    const mpf_class sine = vx * cx + vy * cy, cosine = real(radius.x) * cx + real(radius.y) * cy;
    p.sector = sgn(sine) > 0 ? 1 : 3;
    p.value = p.sector == 1 ? mpf_class(-cosine) : cosine;
    return true;
  }
};

Oracle::Oracle(const Table& table) : data_(std::make_unique<Data>()) {
  for (const Wall& w : table.walls) {
    data_->shapes.push_back(std::visit(Shaper{}, w.curve));
    data_->next.push_back(w.next);
  }
}
Oracle::~Oracle() = default;

Expected Oracle::first(int wall, double u, Vector point, Vector velocity, double omega) const {
  const Data& d = *data_;
  Flying& f = d.flight;
  f.start = wall < 0 ? rational(point) : place(d.shapes[static_cast<std::size_t>(wall)], u);
  f.v = rational(velocity);
  f.omega = mpq_class(omega);
  f.straight = omega == 0.0;
  if (!f.straight) {
    // a = omega J v: the centre lies along J v.
    const mpq_class inverse = 1 / f.omega;
    f.centre = f.start + inverse * right(f.v);
    const Rational radius = f.start - f.centre;
    f.r2 = dot(radius, radius);
  }
  std::vector<Passage> all;
  for (std::size_t i = 0; i < d.shapes.size(); ++i) d.pass(all, static_cast<int>(i));
  d.found.reset();
  Expected answer;
  const bool by_value = d.any_ellipse();
  for (Passage& p : all) {
    if (by_value && !d.set_value(p)) continue;
    int order = -1;
    if (d.found) {
      if (!by_value) {
        order = compare(p.turn, d.found->turn);
      } else if (p.sector != d.found->sector) {
        order = p.sector < d.found->sector ? -1 : 1;
      } else {
        mpf_class gap = p.value - d.found->value, size = abs(p.value) + abs(d.found->value);
        mpf_div_2exp(size.get_mpf_t(), size.get_mpf_t(), 500);
        order = abs(gap) <= size ? 0 : sgn(gap);
      }
    }
    if (order > 0) continue;
    if (order == 0) {
      if (p.joint || d.found->joint) {  // a joint is itself, not a crossing of its walls
        if (!p.joint) continue;
      } else {
        answer.kind = Expected::Kind::cusp;
        continue;
      }
    }
    d.found = p;
    answer.kind = p.joint ? Expected::Kind::joint : Expected::Kind::wall;
    answer.wall = p.wall;
  }
  return answer;
}

bool Oracle::within(double from, double to) const {
  const Data& d = *data_;
  const Passage& p = *d.found;
  const Shape& c = d.shapes[static_cast<std::size_t>(p.wall)];
  if (p.circular) return d.between_ends(c, *p.circular, place(c, from), place(c, to), true);
  const auto number_of = [&](const Rational& at) {  // angles as 0 <= number < 4
    bool infinite = false;
    const mpq_class t = half_angle(c, at, infinite);
    if (infinite) return mpq_class(2);
    if (t >= 0) return t <= 1 ? t : mpq_class(2 - 1 / t);
    return t <= -1 ? mpq_class(2 - 1 / t) : mpq_class(4 + t);
  };
  const mpq_class x = number_of(*p.plain);
  return number_of(place(c, from)) <= x && x < number_of(place(c, to));
}

}  // namespace carom::tests
