#include <arb_mat.h>

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "carom/certify/certified_periodic_orbit.hpp"
#include "certify/flight/beside_curve.hpp"
#include "certify/flight/larmor_flight.hpp"
#include "certify/flight/scene.hpp"
#include "certify/number/enclosure_of.hpp"
#include "certify/number/exact_value.hpp"
#include "table/bezier_wall.hpp"

namespace carom {

using namespace certify;

namespace {

Ball cos_of(const Ball& a) { return made<Ball>(arb_cos, a.raw(), Precision::bits()); }
Ball sin_of(const Ball& a) { return made<Ball>(arb_sin, a.raw(), Precision::bits()); }
BallVector scaled(const Ball& s, const BallVector& v) { return {s * v.x, s * v.y}; }

// A matrix of balls that frees itself.
class Matrix {
 public:
  explicit Matrix(std::size_t n) : n_(static_cast<slong>(n)) { arb_mat_init(m_, n_, n_); }
  Matrix(const Matrix&) = delete;
  Matrix& operator=(const Matrix&) = delete;
  ~Matrix() { arb_mat_clear(m_); }
  void add(std::size_t row, std::size_t column, const Ball& value) {
    arb_ptr entry = arb_mat_entry(m_, row, column);
    arb_add(entry, entry, value.raw(), Precision::bits());
  }
  Ball at(std::size_t row, std::size_t column) const {
    return made<Ball>(arb_set, arb_mat_entry(m_, row, column));
  }
  /// Nearly the inverse, as exact numbers. False: the matrix is singular, nearly.
  bool invert(const Matrix& of) {
    if (arb_mat_approx_inv(m_, of.m_, Precision::bits()) == 0) return false;
    arb_mat_get_mid(m_, m_);
    return true;
  }
  void multiply(const Matrix& a, const Matrix& b) {
    arb_mat_mul(m_, a.m_, b.m_, Precision::bits());
  }
  std::vector<Ball> operator*(const std::vector<Ball>& v) const {
    std::vector<Ball> r(v.size());
    for (std::size_t i = 0; i < v.size(); ++i)
      for (std::size_t k = 0; k < v.size(); ++k) r[i] = r[i] + at(i, k) * v[k];
    return r;
  }

 private:
  slong n_;
  arb_mat_t m_;
};

// The equations of a closed chain (src/orbits/chain.hpp has the same in doubles), with the places
// of the hits and, in a field, the half-turns as unknowns.
class Equations {
 public:
  Equations(const ExactSystem& system, const std::vector<NearHit>& hits)
      : hits_(hits),
        pieces_(*system.spec, table::shapes::written_shape(*system.spec)),
        curved_(table::bezier_wall(*system.table) && !system.table->lattice) {
    const Ball omega = value_of(system.omega);
    if (!curved_) {
      BallTable table = ball_table(*system.spec);
      where_ = whereabouts_of(table, omega);
      scene_.walls = std::move(table.walls);
      scene_.lattice = std::move(table.lattice);
    }
    for (const NearHit& hit : hits) spots_.push_back(pieces_.spot(hit.wall, hit.u));
    speed = value_of(system.speed);
    scene_.motion.speed2 = square(speed);
    scene_.motion.inverse_speed2 = Ball(1) / scene_.motion.speed2;
    scene_.motion.half_omega = omega / 2;
    scene_.motion.turns = sign(omega) != Sign::zero;
    scene_.motion.time_bits = Precision::bits();
    curvature_ = omega / speed;
    field_ = scene_.motion.turns;
  }

  std::size_t size() const { return field_ ? 2 * hits_.size() : hits_.size(); }
  std::vector<Ball> start() const {
    std::vector<Ball> x;
    for (const Pieces::Spot& spot : spots_) x.push_back(spot.t.midpoint());
    if (field_)
      for (const NearHit& hit : hits_) x.emplace_back(hit.half_turn);
    return x;
  }

  struct Flight {
    Ball chord, sine, cosine, half_turn;
    BallVector direction, out, in;
  };
  struct At {
    std::vector<CurvePlace> places;
    std::vector<Flight> flights;
  };
  At at(const std::vector<Ball>& x) const {
    const std::size_t n = hits_.size();
    At r;
    for (std::size_t i = 0; i < n; ++i) r.places.push_back(piece(i).at(x[i]));
    for (std::size_t i = 0; i < n; ++i) {
      BallVector to = r.places[(i + 1) % n].point;
      if (scene_.lattice) to = to + scene_.translation(hits_[i].step);
      const BallVector chord = to - r.places[i].point;
      Flight f;
      f.chord = sqrt(square(chord.x) + square(chord.y));
      f.direction = scaled(Ball(1) / f.chord, chord);
      f.half_turn = field_ ? x[n + i] : Ball(0);
      f.sine = field_ ? sin_of(f.half_turn) : Ball(0);
      f.cosine = field_ ? cos_of(f.half_turn) : Ball(1);
      const BallVector along = scaled(f.cosine, f.direction);
      const BallVector across = scaled(clockwise() * f.sine, left(f.direction));
      f.out = along + across;
      f.in = along - across;
      r.flights.push_back(std::move(f));
    }
    return r;
  }
  std::vector<Ball> sides(const At& a) const {
    const std::size_t n = hits_.size();
    std::vector<Ball> r;
    for (std::size_t i = 0; i < n; ++i)
      r.push_back(dot(a.places[i].first, a.flights[(i + n - 1) % n].in - a.flights[i].out));
    if (field_)
      for (const Flight& f : a.flights) r.push_back(f.sine - half_curvature() * f.chord);
    return r;
  }
  void derivatives(const At& a, Matrix& m) const {
    const std::size_t n = hits_.size();
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t j = (i + 1) % n;
      const CurvePlace &p = a.places[i], &q = a.places[j];
      const Flight &f = a.flights[i], &before = a.flights[(i + n - 1) % n];
      const BallVector across = left(f.direction);
      m.add(i, i, dot(p.second, before.in - f.out));
      const Ball by_p = -(dot(across, p.first) / f.chord), by_q = dot(across, q.first) / f.chord;
      const Ball leaves = -dot(p.first, left(f.out)), arrives = dot(q.first, left(f.in));
      m.add(i, i, leaves * by_p);
      m.add(i, j, leaves * by_q);
      m.add(j, i, arrives * by_p);
      m.add(j, j, arrives * by_q);
      if (!field_) continue;
      m.add(i, n + i, clockwise() * leaves);
      m.add(j, n + i, -(clockwise() * arrives));
      m.add(n + i, n + i, f.cosine);
      m.add(n + i, i, half_curvature() * dot(f.direction, p.first));
      m.add(n + i, j, -(half_curvature() * dot(f.direction, q.first)));
    }
  }

  Ball length(const At& a) const {
    Ball sum(0);
    for (const Flight& f : a.flights)
      sum = sum + (field_ ? f.half_turn / half_curvature() : f.chord);
    return sum;
  }
  // The tangent map across the orbit, of (distance, angle) to its left. A flight of length L turns
  // them as the flow of y'' + k^2 y = 0 does, k its curvature; a reflection by a wall of curvature
  // c takes both negative and adds -2 (c + k t.d)/(n.d) times the distance to the angle, d the
  // direction before, t and n the wall's tangent and normal.
  Ball trace(const At& a) const {
    const std::size_t n = hits_.size();
    Ball m[2][2] = {{Ball(1), Ball(0)}, {Ball(0), Ball(1)}};
    for (std::size_t i = 0; i < n; ++i) {
      const Flight& f = a.flights[i];
      const std::size_t j = (i + 1) % n;
      const CurvePlace& q = a.places[j];
      const Ball c2 = field_ ? square(f.cosine) - square(f.sine) : Ball(1);
      const Ball b = f.chord * f.cosine;  // sin(k L)/k
      const Ball c = -(square(curvature_) * b);
      const Ball rate = sqrt(square(q.first.x) + square(q.first.y));
      const Ball turn(piece(j).turn);
      const BallVector t = scaled(turn / rate, q.first), normal = left(t);
      const Ball bend = turn * cross(q.first, q.second) / (rate * square(rate));
      const Ball kick = -((Ball(2) * (bend + curvature_ * dot(t, f.in))) / dot(normal, f.in));
      for (int column = 0; column < 2; ++column) {
        const Ball distance = c2 * m[0][column] + b * m[1][column];
        const Ball angle = c * m[0][column] + c2 * m[1][column];
        m[0][column] = -distance;
        m[1][column] = kick * distance - angle;
      }
    }
    return m[0][0] + m[1][1];
  }

  // Does each flight meet the next hit's wall first, and there?
  std::string obstacle(const std::vector<Ball>& x, const At& a) const {
    const std::size_t n = hits_.size();
    for (std::size_t i = 0; curved_ && i < n; ++i)
      if (const std::string fault = obstacle_on_curve(x, a, i); !fault.empty()) return fault;
    if (curved_) return {};
    for (std::size_t i = 0; i < n; ++i) {
      const BallVector &P = a.places[i].point, v = scaled(speed, a.flights[i].out);
      const NearHit &from = hits_[i], &to = hits_[(i + 1) % n];
      const Choice next = scene_.next(where_, P, v, from.wall, in_doubles(P), in_doubles(v));
      if (next.answer != Choice::wall)
        return "it cannot be decided which wall a flight meets first";
      if (!(next.first == Copy{to.wall, from.step})) return "another wall is in the way";
      const BallVector seen = scene_.lattice ? P - scene_.translation(from.step) : P;
      const bool same = from.wall == to.wall && from.step == geometry::Cell{};
      const LandingOf<Ball> landing = flight_to<Ball, Ball>(
          scene_.walls[static_cast<std::size_t>(to.wall)], seen, v, scene_.motion, same);
      const BallVector& there = a.places[(i + 1) % n].point;
      if (!landing.position.x.overlaps(there.x) || !landing.position.y.overlaps(there.y))
        return "a flight meets the same wall earlier";
    }
    return {};
  }

  Ball speed;

 private:
  std::string obstacle_on_curve(const std::vector<Ball>& x, const At& a, std::size_t i) const {
    const std::size_t next = (i + 1) % hits_.size();
    const Flight& f = a.flights[i];
    const auto inwards = [&](std::size_t k, const BallVector& v) {
      return sign(Ball(piece(k).turn) * cross(a.places[k].first, v));
    };
    if (inwards(i, f.out) != Sign::positive || inwards(next, f.in) != Sign::negative)
      return "a flight is not inside the table";
    const FlightBetween flight{a.places[i].point, a.places[next].point, f.out, curvature_};
    const Pieces::Spot from{spots_[i].piece, x[i]}, to{spots_[next].piece, x[next]};
    return meets_nowhere_else(pieces_, flight, from, to)
               ? ""
               : "a flight meets a wall earlier, or it cannot be decided";
  }
  Ball half_curvature() const {
    return sign(curvature_) == Sign::negative ? -(curvature_ / 2) : curvature_ / 2;
  }
  Ball clockwise() const { return Ball(sign(curvature_) == Sign::negative ? -1 : 1); }

  const std::vector<NearHit>& hits_;
  const Piece& piece(std::size_t i) const { return pieces_[spots_[i].piece]; }

  Pieces pieces_;
  bool curved_;  ///< else the walls are also those of a scene
  SceneOf<Ball> scene_;
  Whereabouts where_;
  std::vector<Pieces::Spot> spots_;  ///< about the hits
  Ball curvature_;
  bool field_ = false;
};

// Newton's steps at this precision, then Krawczyk's: X = x +- r contains exactly one solution if
// x - C F(x) + (1 - C F'(X)) (X - x) lies inside X, C nearly the inverse of F'(x). Gives that box.
std::optional<std::vector<Ball>> only_solution(const Equations& equations) {
  const std::size_t m = equations.size();
  std::vector<Ball> x = equations.start(), step;
  const auto largest = [](const std::vector<Ball>& v) {
    Bound most;
    for (const Ball& one : v)
      if (most < size_of(one)) most = size_of(one);
    return most;
  };
  // Each step doubles the digits, from 30 bits on at the worst.
  Matrix inverse(m);
  for (double bits = 15.0; bits < 2.0 * static_cast<double>(Precision::bits()); bits *= 2.0) {
    const Equations::At at = equations.at(x);
    Matrix slope(m);
    equations.derivatives(at, slope);
    if (!inverse.invert(slope)) return {};
    step = inverse * equations.sides(at);
    for (std::size_t i = 0; i < m; ++i) x[i] = (x[i] - step[i]).midpoint();
  }
  step = inverse * equations.sides(equations.at(x));
  // The box is tried with twice, and if need be with more of, the last step's size.
  Bound radius = largest(step) * Bound(2.0);
  for (int attempt = 0; attempt < 4; ++attempt, radius = radius * Bound(16.0)) {
    std::vector<Ball> box, from_middle;
    for (const Ball& middle : x) {
      box.push_back(middle.widened(radius));
      from_middle.push_back(Ball(0).widened(radius));
    }
    Matrix slope(m), product(m);
    equations.derivatives(equations.at(box), slope);
    product.multiply(inverse, slope);
    bool inside = true;
    std::vector<Ball> smaller(m);
    for (std::size_t i = 0; i < m; ++i) {
      Ball shift = -step[i];
      for (std::size_t k = 0; k < m; ++k)
        shift = shift + (Ball(i == k ? 1 : 0) - product.at(i, k)) * from_middle[k];
      inside = inside && size_of(shift) < radius;
      smaller[i] = x[i] + shift;
    }
    if (inside) return smaller;
  }
  return {};
}

}  // namespace

CertifiedPeriodicOrbit certify_orbit(const ExactSystem& system, const std::vector<NearHit>& hits,
                                     int digits) {
  CertifiedPeriodicOrbit orbit;
  const double wanted = -static_cast<double>(digits) * std::log2(10.0) - 1.0;
  long bits = static_cast<long>(96.0 - wanted);
  for (int attempt = 0; attempt < 4; ++attempt) {
    const Precision precision(bits);
    const Equations equations(system, hits);
    const std::optional<std::vector<Ball>> box = only_solution(equations);
    if (!box) {
      orbit.reason = "the interval Newton step cannot separate it from its neighbours";
      return orbit;
    }
    const Equations::At at = equations.at(*box);
    orbit.reason = equations.obstacle(*box, at);
    if (!orbit.reason.empty()) return orbit;
    const Ball length = equations.length(at), trace = equations.trace(at);
    std::vector<Ball> all{length, length / equations.speed, trace};
    const Ball square_of_root = square(trace) / 4 - Ball(1);
    if (sign(square_of_root) == Sign::positive) {
      const Ball root = sqrt(square_of_root), half = trace / 2;
      all.push_back(sign(trace) == Sign::negative ? half - root : half + root);
    }
    double worst = -HUGE_VAL;
    for (const Ball& number : all) worst = std::max(worst, number.radius().log2());
    for (const auto& place : at.places)
      worst = std::max({worst, place.point.x.radius().log2(), place.point.y.radius().log2()});
    if (worst >= wanted) {
      bits += static_cast<long>(worst - wanted) + 32;
      continue;
    }
    orbit.proven = true;
    orbit.length = number_of(all[0]);
    orbit.period = number_of(all[1]);
    orbit.trace = number_of(all[2]);
    if (all.size() > 3) orbit.multiplier = number_of(all[3]);
    for (const auto& place : at.places) {
      orbit.x.push_back(number_of(place.point.x));
      orbit.y.push_back(number_of(place.point.y));
    }
    return orbit;
  }
  orbit.reason = "its numbers did not reach the digits";
  return orbit;
}

}  // namespace carom
