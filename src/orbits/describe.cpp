#include "orbits/newton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string_view>
#include <vector>

#include "base/name_among.hpp"
#include "orbits/across.hpp"
#include "orbits/boundary.hpp"
#include "orbits/maslov.hpp"

namespace carom {

const char* name_of(Stability stability) {
  return base::name_among<Stability::parabolic>(
      {"elliptic", "hyperbolic", "inverse hyperbolic", "parabolic"}, stability);
}

OrbitWords words_of(const std::vector<PeriodicOrbit>& found, const Table& table) {
  constexpr std::string_view alphabet = "123456789abcdefghijklmnopqrstuvwxyz";
  const std::vector<int> curves = orbits::smooth_curves(table);
  const auto curve = [&](const OrbitHit& hit) {
    return curves[static_cast<std::size_t>(hit.wall)];
  };
  std::map<int, std::string> letters;
  for (const PeriodicOrbit& orbit : found)
    for (const OrbitHit& hit : orbit.hits) letters[curve(hit)];
  const bool enough = letters.size() <= alphabet.size();
  OrbitWords all;
  for (auto& [wall, letter] : letters) {
    std::string name = table.wall(wall).name;
    // The pieces of a curve are called curve_1, curve_2 ...
    if (std::count(curves.begin(), curves.end(), wall) > 1) name = name.substr(0, name.rfind('_'));
    letter = enough ? std::string(1, alphabet[all.letters.size()]) : name + " ";
    if (enough) all.letters.emplace_back(letter, name);
  }
  for (const PeriodicOrbit& orbit : found) {
    std::string word;
    for (const OrbitHit& hit : orbit.hits) word += letters[curve(hit)];
    if (!enough) word.pop_back();
    all.words.push_back(word);
  }
  return all;
}

namespace orbits {

using geometry::Vector;

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

// The trace of the orbit through other places than the solution's.
double trace_at(const Boundary& boundary, const Chain& chain) {
  const ChainGeometry g = geometry_of(boundary, chain);
  return tangent_map(boundary, chain, g, chain.size()).trace();
}

// An estimate of how far the error of the unknowns moves the trace: that error times the trace's
// derivatives, from differences over 2^-20 of the shortest chord. The differences themselves err by
// about 2^-21 of the chord times the second derivative, and by 2^20 times the rounding of the trace
// over the chord; neither is bounded here.
double trace_error_of_places(const Boundary& boundary, const Solution& solution) {
  const double at = trace_at(boundary, solution.chain), h = 0x1p-20;
  const std::size_t n = solution.chain.size(), m = equations(boundary, solution.chain);
  double sum = 0.0;
  for (std::size_t i = 0; i < m; ++i) {
    const double width = i < n ? h * solution.geometry.shortest : h;
    std::vector<double> step(m, 0.0);
    step[i] = width;
    Chain moved = solution.chain;
    move(boundary, moved, step, 1.0);
    sum += std::abs(trace_at(boundary, moved) - at) / width;
  }
  return sum * solution.error;
}

// How far the curvatures of pieces, which are not those of the curve, move the trace. It is linear
// in each of them.
double trace_error_of_pieces(const Boundary& boundary, const Solution& solution, double trace) {
  const double off = boundary.table->curve_errors.curvature;
  if (off == 0.0) return 0.0;
  double sum = 0.0;
  ChainGeometry g = solution.geometry;
  for (WallPoint& point : g.points) {
    point.curvature += 1.0;
    sum += std::abs(tangent_map(boundary, solution.chain, g, g.points.size()).trace() - trace);
    point.curvature -= 1.0;
  }
  return off * sum;
}

void add_stability(PeriodicOrbit& orbit) {
  const double t = orbit.trace, size = std::abs(t);
  if (size - 2.0 > orbit.trace_error)
    orbit.stability = t > 0.0 ? Stability::hyperbolic : Stability::inverse_hyperbolic;
  else if (2.0 - size > orbit.trace_error)
    orbit.stability = Stability::elliptic;
  else
    orbit.stability = Stability::parabolic;
  if (orbit.stability == Stability::parabolic) {
    orbit.multipliers[0] = orbit.multipliers[1] = t > 0.0 ? 1.0 : -1.0;
  } else if (orbit.stability == Stability::elliptic) {
    const double sine = std::sqrt((2.0 - size) * (2.0 + size)) / 2.0;
    orbit.multipliers[0] = {0.5 * t, sine};
    orbit.multipliers[1] = {0.5 * t, -sine};
  } else {
    const double large = leading_multiplier(t);
    orbit.multipliers[0] = large;
    orbit.multipliers[1] = 1.0 / large;
  }
}

}  // namespace

PeriodicOrbit describe(const Boundary& boundary, const Solution& solution) {
  const Chain& chain = solution.chain;
  const ChainGeometry& g = solution.geometry;
  const Particle& p = boundary.particle;
  const std::size_t n = chain.size();
  PeriodicOrbit orbit;
  double least_cosine = 1.0;
  for (std::size_t i = 0; i < n; ++i) {
    OrbitHit hit;
    hit.wall = chain[i].wall;
    hit.u = chain[i].u;
    hit.s = geometry::arc_length_at(boundary.frames[static_cast<std::size_t>(hit.wall)], hit.u);
    hit.position = g.points[i].position;
    hit.velocity = p.speed * g.flights[i].departure;
    hit.v_parallel = dot(g.points[i].tangent, hit.velocity);
    hit.flight_time = duration_of(boundary, chain[i], g.flights[i]);
    hit.step = chain[i].step;
    least_cosine =
        std::min(least_cosine, std::abs(dot(g.points[i].normal, g.flights[i].departure)));
    orbit.shift.first += hit.step.first;
    orbit.shift.second += hit.step.second;
    orbit.half_turns.push_back(p.omega == 0.0 ? 0.0 : chain[i].half_turn);
    orbit.hits.push_back(hit);
  }
  orbit.length = length_of(boundary, chain, g);
  orbit.period = orbit.length / p.speed;
  const bool closed = orbit.shift == geometry::Cell{};
  orbit.action = p.omega == 0.0 ? p.mass * p.speed * orbit.length
                 : closed
                     ? p.mass * (p.speed * orbit.length + p.omega * area_of(boundary, chain, g))
                     : none;
  AcrossMap sizes;
  orbit.trace = tangent_map(boundary, chain, g, n, &sizes).trace();
  // Without field lengths are stationary: their error is the points' alone. With field each
  // half-turn errs by the unknown's error.
  const double count = static_cast<double>(n);
  orbit.position_error = solution.error;
  orbit.length_error = p.omega == 0.0
                           ? unit_roundoff * count * (24.0 * boundary.size + 4.0 * orbit.length) +
                                 2.0 * count * boundary.table->curve_errors.distance
                           : 2.0 * count * solution.error / std::abs(boundary.flight_curvature());
  // Each factor's entries are sums of a few products of directions, curvature, length and 1/cos,
  // of which the first and the last err as the equations do, over the cosine.
  const double relative = 2.0 * count * residual_error(boundary, g) / least_cosine;
  orbit.trace_error = relative * sizes.trace() + trace_error_of_places(boundary, solution) +
                      trace_error_of_pieces(boundary, solution, orbit.trace);
  orbit.family = solution.lost_rank > 0;
  add_stability(orbit);
  orbit.maslov = maslov_index(flights_across(boundary, chain, g), orbit.stability);
  return orbit;
}

}  // namespace orbits
}  // namespace carom
