#include "certify/pilot.hpp"

#include <algorithm>

#include "certify/pseudo_orbit.hpp"
#include "certify/tangent.hpp"

namespace carom::certify {

Forecast forecast(const SceneOf<double>& scene, const Whereabouts& where, geometry::Vector position,
                  geometry::Vector velocity, int standing, const Horizon& horizon, double unit) {
  Forecast result;
  FrameOf<double> frame{{1.0, 0.0}, velocity, unit};
  // The images of both directions, the longer one normalised: their logarithm grows.
  double a[2] = {1.0, 0.0}, b[2] = {0.0, 1.0};
  double grown = 0.0;
  PseudoState<double> s{position, velocity, 0.0, standing, {}};
  while (result.hits < horizon.hits && result.bits <= horizon.bits) {
    if (result.hits % 256 == 0 && horizon.interrupted != nullptr && *horizon.interrupted && (*horizon.interrupted)()) break;
    const Choice choice = scene.next(where, s.position, s.velocity, s.standing, s.position, s.velocity);
    if (choice.answer != Choice::wall) break;
    const Copy& copy = choice.first;
    const auto& wall = scene.walls[static_cast<std::size_t>(copy.wall)];
    const bool same = copy.wall == s.standing && copy.cell == geometry::Cell{};
    const geometry::Vector from = scene.lattice ? s.position - scene.translation(copy.cell) : s.position;
    const geometry::Vector before = s.velocity;
    fly_to(scene, copy, s);
    if (!(s.time <= horizon.t_max) || !std::isfinite(s.position.x)) break;
    if (scene.hole_at(copy.wall, s.position).verdict == Verdict::yes) break;
    const FrameOf<double> after{tangent_of(wall, s.position), s.velocity, unit};
    const auto map = tangent_map(wall, from, before, scene.motion, same, frame, after);
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
    frame = after;
    ++result.hits;
  }
  return result;
}

}  // namespace carom::certify
