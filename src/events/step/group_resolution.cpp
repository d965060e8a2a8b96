// Does a step resolve the forces that it crosses? forces/resolution.hpp has the criterion.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "carom/integrators/scheme.hpp"
#include "events/step/group.hpp"
#include "forces/nearest_copy.hpp"

namespace carom::events {

using forces::ForceBound;
using geometry::Vector;

void Group::find_maps() {
  maps_.clear();
  if (in_.maps == nullptr) return;
  largest_omega_ = 0.0;
  for (const Particle& p : particles_) {
    maps_.push_back(&in_.maps->of(p));
    largest_omega_ = std::max(largest_omega_, std::fabs(p.omega));
  }
  checked_.position.clear();
  span_ = {};
  far_ = {};
}

/// Is the motion from there analytic over the span? `to`: where a step has led from it, a hint.
bool Group::resolves(const Phase<double>& from, const Phase<double>* to,
                     const forces::resolution::Span& span) const {
  if (in_.forces->interacts() && bodies_.size() > 1) return resolves_pairs(from, span);
  for (std::size_t i = 0; i < maps_.size(); ++i) {
    Vector way{};
    if (to) {
      way = 0.5 * (to->position[i] - from.position[i]);
    } else {
      in_.forces->add_external(particles_[i], from.position[i], way);
      way = (0.5 / particles_[i].mass * span.time * span.time) * way;
    }
    if (!maps_[i]->resolves(from.position[i], dot(from.velocity[i], from.velocity[i]),
                            dot(way, way), span))
      return false;
  }
  return true;
}

namespace {

/// How many times the way of half a step the bounds of far pairs hold for, and how many times as
/// far as two particles may come by then a pair is that counts as far. Both choose what is
/// computed, and when; any bound proves what it proves.
constexpr double far_ways = 6.0, far_pairs = 2.0;

/// The displacement within which a motion is looked for: twice what the acceleration, as far as it
/// is known, asks for.
double room(double speed, double acceleration, const forces::resolution::Span& span) {
  return 2.0 * span.growth * span.time * (speed + 0.5 * acceleration * span.time);
}

}  // namespace

double Group::distance(const Phase<double>& at, std::size_t i, std::size_t j) const {
  const Vector d = at.position[i] - at.position[j];
  return length(in_.lattice ? forces::nearest_copy(d, *in_.lattice) : d);
}

/// Adds the bound of a pair's force to those of both.
void Group::add_pair_bound(std::size_t i, std::size_t j, double distance, double rho,
                           std::vector<ForceBound>& sums) const {
  const ForceBound pair = in_.forces->pair_bound(particles_[i], particles_[j], distance, rho);
  sums[i] += pair;
  sums[j] += pair;
}

/// The bound of a member's acceleration, of that of the forces of its pairs.
ForceBound Group::with_external(const Phase<double>& at, std::size_t i, double rho,
                                const ForceBound& pairs) const {
  ForceBound sum{pairs.force / particles_[i].mass, pairs.jump / particles_[i].mass};
  if (in_.forces->external()) sum += maps_[i]->about(at.position[i], rho);
  return sum;
}

/// Bounds of the forces of all pairs, displaced by rho; none: at the positions themselves.
bool Group::bound_all(const Phase<double>& at, const std::vector<double>& rho,
                      std::vector<ForceBound>& sums) const {
  sums.assign(maps_.size(), {});
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (interrupted(20.0 * static_cast<double>(i))) return false;
    for (std::size_t j = 0; j < i; ++j)
      add_pair_bound(i, j, distance(at, i, j), rho.empty() ? 0.0 : rho[i] + rho[j], sums);
  }
  return true;
}

/// Of particles that interact, each one is displaced while the others are.
bool Group::resolves_pairs(const Phase<double>& from, const forces::resolution::Span& span) const {
  const std::size_t n = maps_.size();
  std::vector<ForceBound> sums;
  std::vector<double> rho;
  if (!bound_all(from, {}, sums)) return true;
  for (std::size_t i = 0; i < n; ++i)
    rho.push_back(room(length(from.velocity[i]), with_external(from, i, 0.0, sums[i]).force, span));
  if (!bound_all(from, rho, sums)) return true;
  for (std::size_t i = 0; i < n; ++i) {
    const double speed = length(from.velocity[i]);
    const ForceBound all = with_external(from, i, rho[i], sums[i]);
    if (!forces::resolution::stays(speed, all.force, span, rho[i])) return false;
    if (all.jump > 0.0 && !(all.jump * forces::resolution::steps_a_radius * span.time <=
                            forces::resolution::kick_share * speed))
      return false;
  }
  return true;
}

/// True is the answer of resolves_pairs(), false is none: by bounds of far pairs that hold about
/// where the group was some steps ago, and those of near pairs as they are now. No bound is smaller
/// than that function's, and `least` no larger than what it takes for the forces at the positions.
bool Group::near_pairs_resolve(const Phase<double>& from, const forces::resolution::Span& span) {
  const std::size_t n = maps_.size();
  if (far_.force.size() != n || interrupted(20.0 * static_cast<double>(n + far_.near.size())))
    return false;
  std::vector<ForceBound> near(n), sums = far_.force;
  std::vector<double> distances, least, rho;
  for (const auto& [i, j] : far_.near) {
    distances.push_back(distance(from, i, j));
    add_pair_bound(i, j, distances.back(), 0.0, near);
  }
  bool holds = true;
  for (std::size_t i = 0; i < n; ++i) {
    least.push_back(with_external(from, i, 0.0, near[i]).force);
    far_.here[i] = least[i] + far_.force[i].force / particles_[i].mass;
    rho.push_back(room(length(from.velocity[i]), far_.here[i], span));
    holds = holds && length(from.position[i] - far_.centre[i]) + rho[i] <= far_.radius[i];
  }
  if (!holds) return false;
  for (std::size_t k = 0; k < far_.near.size(); ++k) {
    const auto& [i, j] = far_.near[k];
    add_pair_bound(i, j, distances[k], rho[i] + rho[j], sums);
  }
  for (std::size_t i = 0; i < n; ++i) {
    const double speed = length(from.velocity[i]);
    const ForceBound all = with_external(from, i, rho[i], sums[i]);
    const auto stays = [&](double real) {
      return forces::resolution::stays(speed, all.force, span, room(speed, real, span));
    };
    if (all.jump > 0.0 || !(stays(least[i]) || stays(force_there(from, i)))) return false;
  }
  return true;
}

/// The bound of one member's acceleration at the positions themselves.
double Group::force_there(const Phase<double>& at, std::size_t i) const {
  ForceBound sum;
  if (interrupted(20.0 * static_cast<double>(maps_.size()))) return 0.0;
  for (std::size_t j = 0; j < maps_.size(); ++j)
    if (j != i)
      sum += in_.forces->pair_bound(particles_[i], particles_[j], distance(at, i, j), 0.0);
  return with_external(at, i, 0.0, sum).force;
}

/// Bounds the far pairs anew, about that phase.
void Group::find_far_pairs(const Phase<double>& from, const forces::resolution::Span& span) {
  const std::size_t n = maps_.size();
  FarPairs found;
  found.here = far_.here;
  if (found.here.size() != n) {
    std::vector<ForceBound> pairs;
    if (!bound_all(from, {}, pairs)) return;
    for (std::size_t i = 0; i < n; ++i)
      found.here.push_back(with_external(from, i, 0.0, pairs[i]).force);
  }
  for (std::size_t i = 0; i < n; ++i)
    found.radius.push_back(far_ways * room(length(from.velocity[i]), found.here[i], span));
  found.centre = from.position;
  found.force.assign(n, {});
  for (std::size_t i = 0; i < n; ++i) {
    if (interrupted(20.0 * static_cast<double>(i))) return;
    for (std::size_t j = 0; j < i; ++j) {
      const double apart = distance(from, i, j), reach = found.radius[i] + found.radius[j];
      if (apart > far_pairs * reach)
        add_pair_bound(i, j, apart, reach, found.force);
      else
        found.near.emplace_back(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j));
    }
    constexpr std::size_t most_near = std::size_t{1} << 22;  // some tens of megabytes
    if (found.near.size() > most_near) return void(far_ = {});
  }
  far_ = std::move(found);
}

/// Near pairs first, and all of them where these cannot tell.
bool Group::resolves_at(const Phase<double>& at, const Phase<double>& other,
                        const forces::resolution::Span& span) {
  if (!in_.forces->interacts() || bodies_.size() == 1) return resolves(at, &other, span);
  if (near_pairs_resolve(at, span)) return true;
  find_far_pairs(at, span);
  return near_pairs_resolve(at, span) || resolves_pairs(at, span);
}

/// The longest of asked, asked/2, asked/4, ... that resolves the forces from there on; 0 if none
/// does.
double Group::longest_step(const Phase<double>& from, const double& asked) const {
  if (maps_.empty()) return asked;
  constexpr int most_halvings = 60;
  constexpr double work = 1e6;  // of a halving: many meshes are new
  double time = asked;
  for (int k = 0; k < most_halvings && !interrupted(k > 0 ? work : 0.0); ++k, time *= 0.5)
    if (resolves(from, nullptr, forces::resolution::span_of(time, largest_omega_))) return time;
  return 0.0;
}

/// Whether the step under way, from phase_ to the path's end, resolves the forces; if not, why.
std::string Group::check_resolution() {
  if (maps_.empty()) return {};
  const Phase<double>&from = path_->start().phase, &to = path_->end().phase;
  const double step = path_->end().time;
  if (!(step > 0.0)) return {};
  if (is_adaptive(in_.plan.scheme))
    return {};  // these ask for the longest step before they take it
  const double radius = resolution_radius(step);
  if (span_.time != radius) {
    span_ = forces::resolution::span_of(radius, largest_omega_);
    checked_.position.clear();
  }
  const bool goes_on = checked_.position == from.position && checked_.velocity == from.velocity;
  checked_.position.clear();
  if (!goes_on && !resolves_at(from, to, span_)) return describe_unresolved(from, step, radius);
  if (!resolves_at(to, from, span_)) return describe_unresolved(to, step, radius);
  checked_ = to;
  return {};
}

std::string Group::describe_unresolved(const Phase<double>& at, double step, double radius) {
  // What is counted, or halved, is not reported.
  if (in_.plan.count_unresolved || !describes_) return "not resolved";
  const double shorter = step / radius * longest_step(at, radius);
  // The member that is to blame, where particles do not interact.
  std::size_t member = 0;
  const forces::resolution::Span span = forces::resolution::span_of(radius, largest_omega_);
  while (member + 1 < maps_.size()) {
    if (!maps_[member]->resolves(at.position[member], dot(at.velocity[member], at.velocity[member]),
                                 0.0, span))
      break;
    ++member;
  }
  const Vector x = at.position[member];
  if (shorter > 0.0)
    return fmt::format(
        "a step of {:.3g} does not resolve the forces near ({:.6g}, {:.6g}); there it may be "
        "{:.3g} at most",
        step, x.x, x.y, shorter);
  return fmt::format("no step resolves the forces near ({:.6g}, {:.6g}), where they have no bound",
                     x.x, x.y);
}

}  // namespace carom::events
