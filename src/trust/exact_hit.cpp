#include "trust/exact_hit.hpp"

#include <cmath>

#include "base/fused_pair.hpp"
#include "certify/flight/larmor_circle.hpp"
#include "certify/wall/start.hpp"

namespace carom {

// By the series of a sixteenth of the angle, which is doubled four times; 1 - cos is kept instead
// of cos.
void sin_cos(Twofold& sin, Twofold& cos, const Twofold& x) {
  const Twofold y(x.high / 16.0, x.low / 16.0), z = y * y;
  const double w = z.value();
  // The terms from y^9 on are below 2^-36 of the first: their digits in a double suffice.
  const double s9 =
      w * (1.0 / 362880 - w * (1.0 / 39916800 - w * (1.0 / 6227020800 - w / 1307674368000.0)));
  const double c10 =
      w * (1.0 / 3628800 - w * (1.0 / 479001600 - w * (1.0 / 87178291200 - w / 20922789888000.0)));
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
  sin = s;
  cos = Twofold(1.0) - m;
}

}  // namespace carom

namespace carom::trust {

using geometry::Vector;

namespace {

// Steps below this share of a flight err by their square, beyond what two doubles hold of the
// error.
constexpr double small_step = 1e-11;
constexpr int most_steps = 8;

Vector rounded(const TwofoldVector& v) { return {v.x.value(), v.y.value()}; }
TwofoldVector exactly(Vector v) { return {v.x, v.y}; }

}  // namespace

namespace {

[[gnu::always_inline]] inline std::optional<OrbitError> error_beyond(const WrittenSystem& system,
                                                                     const State& before,
                                                                     const OrbitError& error,
                                                                     const HitEvent& hit) {
  const certify::WallOf<Twofold>& wall = system.table.walls[static_cast<std::size_t>(hit.wall)];
  TwofoldVector start = exactly(before.position) + exactly(error.position);
  const TwofoldVector velocity = exactly(before.velocity) + exactly(error.velocity);
  if (!(before.cell == hit.cell))
    start = start + system.table.lattice->at(
                        {before.cell.first - hit.cell.first, before.cell.second - hit.cell.second});
  certify::MotionOf<Twofold> motion;
  motion.turns = system.omega.high != 0.0;
  motion.half_omega = {0.5 * system.omega.high, 0.5 * system.omega.low};
  const Twofold engine =
      Twofold(hit.time.high, hit.time.low) - Twofold(before.time.high, before.time.low);
  const auto normal_at = [&](const TwofoldVector& at) {
    return wall.form == certify::Form::segment ? wall.normal : certify::normal_at(wall, at);
  };
  const double per_normal =
      wall.form == certify::Form::segment ? 1.0 : 2.0;  // of the slope of level_at
  Twofold duration = engine - Twofold(error.time);
  // Newton's steps to the wall, each from the exact path; of the last one nothing is left beyond
  // its square.
  for (int step = 0; step < most_steps; ++step) {
    TwofoldVector at = start, v = velocity;
    certify::fly_for(duration, at, v, motion);
    const double late = -level_at(wall, at).value() / (per_normal * dot(normal_at(at), v).value());
    if (!(std::fabs(late) <= 0.5 * engine.high + std::fabs(error.time))) return std::nullopt;
    if (std::fabs(late) > small_step * engine.high) {
      duration = duration + Twofold(late);
      continue;
    }
    const Vector there = rounded(v);
    at = at + Twofold(late) * v;
    v = certify::reflected(v + exactly((system.omega.high * late) * right(there)), normal_at(at));
    return OrbitError{rounded(at - exactly(hit.position)), rounded(v - exactly(hit.after)),
                      ((duration + Twofold(late)) + (Twofold(error.time) - engine)).value()};
  }
  return std::nullopt;
}

}  // namespace

// All in one function: else each product asks if the processor fuses.
[[gnu::flatten]] std::optional<OrbitError> error_after(const WrittenSystem& system,
                                                       const State& before, const OrbitError& error,
                                                       const HitEvent& hit) {
  if (!base::fuses()) return error_beyond(system, before, error, hit);
  base::fuses_surely();
  return error_beyond(system, before, error, hit);
}

OrbitError error_of_start(const WrittenSystem& system, const State& start, bool first_particle) {
  OrbitError error;
  const auto& [walls, lattice] = system.table;
  if (first_particle && system.position) {
    TwofoldVector there = *system.position;
    if (lattice) there = there + lattice->at({-start.cell.first, -start.cell.second});
    error.position = rounded(there - exactly(start.position));
  } else if (start.wall >= 0) {
    const TwofoldVector there =
        certify::point_with_parameter(walls[static_cast<std::size_t>(start.wall)], start.u);
    error.position = rounded(there - exactly(start.position));
  }
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

}  // namespace carom::trust
