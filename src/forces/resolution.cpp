#include "forces/resolution.hpp"

#include <algorithm>

#include "carom/base/elementary.hpp"

namespace carom::forces {

using geometry::Vector;

resolution::Span resolution::span_of(double time, double omega) {
  const double turn = std::fabs(omega) * time, growth = turn > 0.0 ? elementary::exp(turn) : 1.0;
  return {time, growth, 1.0 / (growth * time)};
}

ForceMap::ForceMap(const ForceField& forces, const Particle& kind)
    : forces_(forces), kind_(kind), first_finer_(forces.typed() ? 0 : 1), entries_(kept_entries) {}

const ForceMap::Entry& ForceMap::compute(Entry& kept, std::uint64_t key, int exponent, double i,
                                         double j) const {
  const double mesh = power_of_two(exponent);
  const Vector low{i * mesh, j * mesh};
  const ForceBound bound =
      forces_.external_bound(kind_, {low, low + Vector{mesh, mesh}, 2.0 * mesh});
  const auto up = [&](double x) { return static_cast<float>(x / kind_.mass * (1.0 + 0x1p-20)); };
  kept = {key, up(bound.force), up(bound.jump)};
  return kept;
}

void ForceMap::resolve_known(const Motions& motions, const resolution::Span& span,
                             bool* known) const {
  int which[most_at_once] = {}, count = 0;
  for (int k = 0; k < motions.count; ++k) which[k] = k;
  resolve_known(motions, first_finer_, which, motions.count, span, known);
  for (int k = 0; k < motions.count; ++k) {
    which[count] = k;
    count += !known[k];
  }
  if (count > 0) resolve_known(motions, first_finer_ + 1, which, count, span, known);
}

// The arithmetic of resolves() and stays().
void ForceMap::resolve_known(const Motions& motions, int finer, const int* which, int count,
                             const resolution::Span& span, bool* known) const {
  std::uint64_t key[most_at_once];
  std::uint32_t slot[most_at_once];
  double most[most_at_once];  // without force
  const double square_time = span.time * span.time, square_growth = span.growth * span.growth;
  for (int n = 0; n < count; ++n) {
    const int k = which[n];
    const double by_speed = motions.square_speed[k] * square_time, way = motions.square_way[k];
    const double square = square_growth * (way > by_speed ? way : by_speed);
    const int e = exponent_of(square) - finer;
    const double over = power_of_two(-e), i = motions.x[k] * over, j = motions.y[k] * over;
    const Place place = place_of(e, i, j);
    key[n] = place.key;
    slot[n] = static_cast<std::uint32_t>(place.slot);
    most[n] = power_of_two(e + 1) * span.over_time;
    known[k] = (square > 0x1p-1000) & (square < 0x1p1000) & has_key(i, j);
  }
  for (int n = 0; n < count; ++n) {
    const int k = which[n];
    const Entry& kept = entries_[slot[n]];
    const double left = most[n] - 0.5 * static_cast<double>(kept.force) * span.time;
    known[k] = known[k] & (kept.key == key[n]) & (left >= 0.0) &
               (motions.square_speed[k] <= left * left) & (kept.jump == 0.0f);
  }
}

/// With finer meshes, down to those of half the way; and, for motions that force keeps slow, with
/// coarser ones.
bool ForceMap::resolves_closely(Vector x, double square_speed, int coarsest,
                                const resolution::Span& span) {
  if (!std::isfinite(x.x + x.y + square_speed + span.growth)) return false;
  const auto any = [&](int from, int to) {
    for (int e = from; e >= to; --e)
      if (e > -1000 && e < 1000 && stays(x, square_speed, e, span)) return true;
    return false;
  };
  // At rest where no force acts, as at an equilibrium, any displacement may serve.
  if (coarsest == no_exponent) return any(40, -400);
  constexpr int levels = 6, coarser = 20;
  return any(coarsest - first_finer_ - 1, coarsest - levels) ||
         any(coarsest + coarser, coarsest - first_finer_ + 1);
}

ForceBound ForceMap::about(Vector x, double rho) {
  if (!(rho < 0x1p900) || !std::isfinite(x.x + x.y))
    return {std::numeric_limits<double>::infinity(), 0.0};
  // A mesh of at least half of rho.
  const int e =
      rho > 0x1p-900 ? static_cast<int>(std::bit_cast<std::uint64_t>(rho) >> 52) - 1023 : -900;
  const double over = power_of_two(-e);
  const Entry& found = entry(e, x.x * over, x.y * over);
  return {static_cast<double>(found.force), static_cast<double>(found.jump)};
}

bool ForceMap::resolves_everywhere(Vector low, Vector high, double energy,
                                   const std::function<bool(Vector)>& inside,
                                   const resolution::Span& span, int& left) {
  const double side = std::max(high.x - low.x, high.y - low.y);
  if (!(side > 0x1p-900 && side < 0x1p900)) return true;
  constexpr int finer = 4;  // so that no mesh of the first ones is much of the box
  const int e = static_cast<int>(std::bit_cast<std::uint64_t>(side) >> 52) - 1022 - finer;
  const double over = power_of_two(-e);
  for (double i = std::floor(low.x * over); i <= std::floor(high.x * over); i += 1.0)
    for (double j = std::floor(low.y * over); j <= std::floor(high.y * over); j += 1.0)
      if (!resolves_mesh(e, i, j, energy, inside, span, left)) return false;
  return true;
}

bool ForceMap::resolves_mesh(int exponent, double i, double j, double energy,
                             const std::function<bool(Vector)>& inside,
                             const resolution::Span& span, int& left) {
  if (--left < 0) return false;
  const double mesh = power_of_two(exponent);
  double kinetic = -1.0;
  bool domain = false;
  for (const double p : {0.5, 0.0, 1.0})
    for (const double q : {0.5, 0.0, 1.0}) {
      const Vector x{(i + p) * mesh, (j + q) * mesh};
      domain = domain || inside(x);
      Vector unused{};
      kinetic = std::max(kinetic, energy - forces_.add_external(kind_, x, unused));
    }
  if (!domain || !(kinetic >= 0.0)) return true;
  const double square_speed = 2.0 * kinetic / kind_.mass;
  if (stays({(i + 0.5) * mesh, (j + 0.5) * mesh}, square_speed, exponent, span)) return true;
  const double least = span.growth * span.time * std::sqrt(square_speed);
  if (!(2.0 * mesh > least) || exponent < -900) return false;
  for (const double p : {0.0, 1.0})
    for (const double q : {0.0, 1.0})
      if (!resolves_mesh(exponent - 1, 2.0 * i + p, 2.0 * j + q, energy, inside, span, left))
        return false;
  return true;
}

ForceMap& ForceMaps::of(const Particle& kind) {
  for (const auto& map : maps_)
    if (map->kind().mass == kind.mass && map->kind().charge == kind.charge &&
        map->kind().omega == kind.omega)
      return *map;
  return *maps_.emplace_back(std::make_unique<ForceMap>(forces_, kind));
}

}  // namespace carom::forces
