#include "analyses/relax/search.hpp"

#include <algorithm>
#include <limits>

namespace carom::analyses {

using geometry::Vector;

namespace {

Site at_start(const Landscape& landscape, int wall) {
  const geometry::CurveFrame& f = landscape.frames()[static_cast<std::size_t>(wall)];
  const double u = geometry::first_parameter;
  return {geometry::point_at(f, u), wall, u, false, 0};
}
Site at_end(const Landscape& landscape, int wall) {
  const geometry::CurveFrame& f = landscape.frames()[static_cast<std::size_t>(wall)];
  return {geometry::point_at(f, f.last), wall, f.last, false, 0};
}

/// The point of a wall that is nearest, by its parameter.
Site on_nearest_wall(const Landscape& landscape, Vector point) {
  Site best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t w = 0; w < landscape.frames().size(); ++w) {
    const geometry::CurveFrame& f = landscape.frames()[w];
    const double u =
        std::clamp(geometry::parameter_of(f, point), geometry::first_parameter, f.last);
    const Vector on = geometry::point_at(f, u), d = on - point;
    if (dot(d, d) < least) {
      least = dot(d, d);
      best = {on, static_cast<int>(w), u, false};
    }
  }
  return best;
}

}  // namespace

bool keep_inside(const Landscape& landscape, const World& world, const Sites& before, Sites& now) {
  bool changed = false;
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (now[i].wall >= 0) continue;
    Vector in = before[i].position, out = now[i].position;
    if (world.contains(out)) continue;
    // The wall is found well enough when halving gets no further; the minimum does not depend on
    // it.
    for (int k = 0; k < 60; ++k) {
      const Vector middle = 0.5 * (in + out);
      if (middle == in || middle == out) break;
      (world.contains(middle) ? in : out) = middle;
    }
    now[i] = on_nearest_wall(landscape, in);
    changed = true;
  }
  return changed;
}

bool release_one(const Landscape& landscape, Sites& sites, double least) {
  const std::vector<Vector> force = landscape.forces(sites);
  std::size_t best = sites.size();
  double most = least;
  Site released;
  const auto offer = [&](std::size_t i, double pull, const Site& to) {
    if (!(pull > most)) return;
    most = pull;
    best = i;
    released = to;
  };
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const Site& s = sites[i];
    if (s.wall < 0) continue;
    if (!s.corner) {
      offer(i, dot(force[i], landscape.normal(s)), {s.position});
      continue;
    }
    const Site before = at_end(landscape, landscape.previous(s.wall)),
               after = at_start(landscape, s.wall);
    offer(i, -dot(force[i], landscape.tangent(before)), before);
    offer(i, dot(force[i], landscape.tangent(after)), after);
  }
  if (best == sites.size()) return false;
  sites[best] = released;
  return true;
}

bool turn_corners(const Landscape& landscape, Sites& sites) {
  std::vector<int> beyond;
  for (Site& s : sites) {
    beyond.push_back(s.end);
    if (s.end != 0) s = s.end > 0 ? at_end(landscape, s.wall) : at_start(landscape, s.wall);
  }
  if (std::all_of(beyond.begin(), beyond.end(), [](int end) { return end == 0; })) return false;
  const std::vector<Vector> force = landscape.forces(sites);
  for (std::size_t i = 0; i < sites.size(); ++i) {
    if (beyond[i] == 0) continue;  // it may be on no wall
    Site& s = sites[i];
    const double forward = static_cast<double>(beyond[i]);
    if (!(forward * dot(force[i], landscape.tangent(s)) > 0.0)) continue;
    const Site next = beyond[i] > 0 ? at_start(landscape, landscape.next(s.wall))
                                    : at_end(landscape, landscape.previous(s.wall));
    if (forward * dot(force[i], landscape.tangent(next)) > 0.0)
      s = next;
    else if (beyond[i] > 0)
      s = {next.position, next.wall, next.u, true, 0};
    else
      s.corner = true;
  }
  return true;
}

}  // namespace carom::analyses
