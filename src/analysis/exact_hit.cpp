#include "analysis/exact_hit.hpp"

#include <cmath>

namespace carom {

using geometry::Cell;
using geometry::Vector;

namespace {

// Steps below this share of a flight err by their square, beyond what two doubles hold of the error.
constexpr double small_step = 1e-11;
constexpr int most_steps = 8;

Vector rounded(const TwofoldVector& v) { return {v.x.value(), v.y.value()}; }
TwofoldVector exactly(Vector v) { return {v.x, v.y}; }

TwofoldVector translation(const WrittenSystem& w, const Cell& from, const Cell& to) {
  const Twofold first(static_cast<double>(from.first - to.first)), second(static_cast<double>(from.second - to.second));
  return first * w.first + second * w.second;
}

/// A normal of any length, and (for conics) how far the point is off the wall.
struct Foot {
  TwofoldVector normal;
  double gap = 0.0, slope = 0.0;  ///< of the wall's equation, and how fast it changes along the flight
};

Foot foot_of(const WrittenWall& wall, const TwofoldVector& at, const TwofoldVector& v) {
  if (wall.straight) {
    const TwofoldVector n = left(wall.chord);
    return {n, dot(n, at - wall.from).value(), dot(n, v).value()};
  }
  const TwofoldVector e = at - wall.centre;
  if (wall.circular) return {e, (dot(e, e) - wall.square).value(), 2.0 * dot(e, v).value()};
  const Twofold x = dot(wall.along, e), y = dot(wall.across, e);
  const TwofoldVector n = x * wall.along + y * wall.across;
  return {n, (x * x + y * y - wall.square).value(), 2.0 * dot(n, v).value()};
}

}  // namespace

// By the series of a sixteenth of the angle, which is doubled four times; 1 - cos is kept instead of cos.
SinCosTwofold sincos(const Twofold& x) {
  const Twofold y(x.high / 16.0, x.low / 16.0), z = y * y;
  const double w = z.value();
  // The terms from y^9 on are below 2^-36 of the first: their digits in a double suffice.
  const double s9 = w * (1.0 / 362880 - w * (1.0 / 39916800 - w * (1.0 / 6227020800 - w / 1307674368000.0)));
  const double c10 = w * (1.0 / 3628800 - w * (1.0 / 479001600 - w * (1.0 / 87178291200 - w / 20922789888000.0)));
  const auto part = [](double n) { return Twofold(1.0) / Twofold(n); };
  static const Twofold third = part(6), fifth = part(120), seventh = part(5040);
  static const Twofold fourth = part(24), sixth = part(720), eighth = part(40320);
  Twofold s = y - y * z * (third - z * (fifth - z * (seventh - Twofold(s9))));
  Twofold m = z * (Twofold(0.5) - z * (fourth - z * (sixth - z * (eighth - Twofold(c10)))));
  for (int i = 0; i < 4; ++i) {
    const Twofold t = s * (Twofold(1.0) - m), q = s * s;
    s = t + t;
    m = q + q;
  }
  return {s, Twofold(1.0) - m};
}

std::optional<OrbitError> error_after(const WrittenSystem& system, const State& before, const OrbitError& error,
                                      const HitEvent& hit) {
  const WrittenWall& wall = system.walls[static_cast<std::size_t>(hit.wall)];
  TwofoldVector start = exactly(before.position) + exactly(error.position);
  const TwofoldVector velocity = exactly(before.velocity) + exactly(error.velocity);
  if (!(before.cell == hit.cell)) start = start + translation(system, before.cell, hit.cell);
  const double omega = system.omega.high;
  const Twofold half(0.5 * omega, 0.5 * system.omega.low);
  const Twofold engine = Twofold(hit.time.high, hit.time.low) - Twofold(before.time.high, before.time.low);
  Twofold duration = engine - Twofold(error.time);
  // Newton's steps to the wall, each from the exact path; of the last one nothing is left beyond its square.
  for (int step = 0; step < most_steps; ++step) {
    TwofoldVector at = start, v = velocity;
    if (omega == 0.0) {
      at = at + duration * v;
    } else {
      const auto [s, c] = sincos(half * duration);
      at = at + (s / half) * (c * v + s * right(v));
      v = v + (s + s) * (c * right(v) - s * v);
    }
    const Foot near = foot_of(wall, at, v);
    const double late = -near.gap / near.slope;
    if (!(std::fabs(late) <= 0.5 * engine.high + std::fabs(error.time))) return std::nullopt;
    if (std::fabs(late) > small_step * engine.high) {
      duration = duration + Twofold(late);
      continue;
    }
    const Vector there = rounded(v);
    at = at + Twofold(late) * v;
    v = v + exactly((omega * late) * right(there));
    const TwofoldVector n = wall.straight ? near.normal : foot_of(wall, at, v).normal;
    v = v - (Twofold(2.0) * dot(n, v) / dot(n, n)) * n;
    return OrbitError{rounded(at - exactly(hit.position)), rounded(v - exactly(hit.after)),
                      ((duration + Twofold(late)) + (Twofold(error.time) - engine)).value()};
  }
  return std::nullopt;
}

OrbitError error_of_start(const WrittenSystem& system, const State& start, bool first_particle) {
  OrbitError error;
  if (first_particle && system.position)
    error.position = rounded(*system.position + translation(system, Cell{}, start.cell) - exactly(start.position));
  else if (start.wall >= 0)
    error.position =
        rounded(system.walls[static_cast<std::size_t>(start.wall)].point(start.u) - exactly(start.position));
  if (first_particle && system.velocity) {
    error.velocity = rounded(*system.velocity - exactly(start.velocity));
  } else {
    // The length is the speed; the direction is that of the doubles.
    const TwofoldVector v = exactly(start.velocity);
    const double excess = (dot(v, v) - system.speed * system.speed).value();
    error.velocity = (-0.5 * excess / (system.speed.high * system.speed.high)) * start.velocity;
  }
  return error;
}

}  // namespace carom
