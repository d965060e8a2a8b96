#include "certify/pilot.hpp"

#include <algorithm>

#include "certify/pseudo_orbit.hpp"
#include "certify/tangent.hpp"

namespace carom::certify {

Forecast forecast(const SceneOf<double>& scene, const Whereabouts& where, geometry::Vector position,
                  geometry::Vector velocity, int standing, std::uint64_t most_hits, double t_max,
                  double unit) {
  Forecast result;
  FrameOf<double> frame{{1.0, 0.0}, velocity, unit};
  // The images of both directions, the longer one normalised: their logarithm grows.
  double a[2] = {1.0, 0.0}, b[2] = {0.0, 1.0};
  double grown = 0.0, t = 0.0;
  while (result.hits < most_hits) {
    const Choice choice = scene.next(where, position, velocity, standing, position, velocity);
    if (choice.answer != Choice::wall) break;
    const auto& wall = scene.walls[static_cast<std::size_t>(choice.first.wall)];
    const bool same = choice.first.wall == standing && choice.first.cell == geometry::Cell{};
    if (scene.lattice) position = position - scene.translation(choice.first.cell);
    LandingOf<double> landing = flight_to<double, double>(wall, position, velocity, scene.motion, same);
    t += landing.time;
    // Speed and place on the curve are put right, as in Attempt::settle.
    const double speed2 = scene.motion.speed2;
    const double stretch = 1.0 + (speed2 - dot(landing.velocity, landing.velocity)) / (2.0 * speed2);
    landing.velocity = stretch * landing.velocity;
    if (same && wall.form != Form::segment) landing.position = put_back(wall, landing.position);
    if (!(t <= t_max) || !std::isfinite(landing.position.x)) break;
    if (scene.hole_at(choice.first.wall, landing.position).verdict == Verdict::yes) break;
    const FrameOf<double> after{tangent_of(wall, landing.position), landing.velocity, unit};
    const auto map = tangent_map(wall, position, velocity, scene.motion, same, frame, after);
    const auto apply = [&map](double (&x)[2]) {
      const double along_wall = map.rows[along][along] * x[0] + map.rows[along][turning] * x[1];
      x[1] = map.rows[turning][along] * x[0] + map.rows[turning][turning] * x[1];
      x[0] = along_wall;
    };
    apply(a);
    apply(b);
    const double size = std::sqrt(a[0] * a[0] + a[1] * a[1] + b[0] * b[0] + b[1] * b[1]);
    if (!(size > 0.0) || !std::isfinite(size)) break;
    result.bits = std::max(result.bits, grown + std::log2(size));
    if (size > 0x1p100) {
      for (double* x : {&a[0], &a[1], &b[0], &b[1]}) *x /= size;
      grown += std::log2(size);
    }
    position = landing.position;
    velocity = landing.velocity;
    frame = after;
    standing = choice.first.wall;
    ++result.hits;
  }
  return result;
}

}  // namespace carom::certify
