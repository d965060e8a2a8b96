// Does a step resolve the forces that it crosses? forces/resolution.hpp has the criterion.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "carom/integrators/scheme.hpp"
#include "events/step/group.hpp"
#include "forces/nearest_copy.hpp"

namespace carom::events {

using forces::ForceBound;
using geometry::Vector;

namespace {}  // namespace

void Group::find_maps() {
  maps_.clear();
  if (in_.maps == nullptr) return;
  largest_omega_ = 0.0;
  for (const Particle& p : particles_) {
    maps_.push_back(&in_.maps->of(p));
    largest_omega_ = std::max(largest_omega_, std::fabs(p.omega));
  }
  checked_.position.clear();
}

/// Is the motion from there analytic over the span? `to`: where a step has led from it, a hint.
/// `ahead`: with the margin of forces::resolution::Checks.
bool Group::resolves(const Phase<double>& from, const Phase<double>* to,
                     const forces::resolution::Span& span, bool ahead) const {
  if (in_.forces->interacts() && bodies_.size() > 1) return resolves_pairs(from, span, ahead);
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

/// Of particles that interact, each one is displaced while the others are.
bool Group::resolves_pairs(const Phase<double>& from, const forces::resolution::Span& span,
                           bool ahead) const {
  const ForceField& forces = *in_.forces;
  const std::size_t n = maps_.size();
  std::vector<double> rho(n, 0.0), acceleration(n), jump(n), speed(n);
  const auto bound = [&] {
    for (std::size_t i = 0; i < n; ++i) {
      const ForceBound external =
          forces.external() ? maps_[i]->about(from.position[i], rho[i]) : ForceBound{};
      acceleration[i] = external.force;
      jump[i] = external.jump;
    }
    for (std::size_t i = 0; i < n; ++i) {
      if (interrupted(20.0 * static_cast<double>(i))) return;
      for (std::size_t j = 0; j < i; ++j) {
        Vector d = from.position[i] - from.position[j];
        if (in_.lattice) d = forces::nearest_copy(d, *in_.lattice);
        const ForceBound pair =
            forces.pair_bound(particles_[i], particles_[j], length(d), rho[i] + rho[j]);
        acceleration[i] += pair.force / particles_[i].mass;
        acceleration[j] += pair.force / particles_[j].mass;
        jump[i] += pair.jump / particles_[i].mass;
        jump[j] += pair.jump / particles_[j].mass;
      }
    }
  };
  bound();  // of the forces at the real positions
  const double share = ahead ? 0.5 : 1.0;
  for (std::size_t i = 0; i < n; ++i) {
    speed[i] = length(from.velocity[i]);
    rho[i] = 2.0 / share * span.growth * span.time * (speed[i] + 0.5 * acceleration[i] * span.time);
  }
  bound();
  for (std::size_t i = 0; i < n; ++i) {
    if (!forces::resolution::stays(speed[i], acceleration[i], span, share * rho[i])) return false;
    if (jump[i] > 0.0 && !(!ahead && jump[i] * forces::resolution::steps_a_radius * span.time <=
                                         forces::resolution::kick_share * speed[i]))
      return false;
  }
  return true;
}

/// The longest of asked, asked/2, asked/4, ... that resolves the forces from there on; 0 if none
/// does.
double Group::longest_step(const Phase<double>& from, const double& asked) const {
  if (maps_.empty()) return asked;
  constexpr int most_halvings = 60;
  constexpr double work = 1e6;  // of a halving: many meshes are new
  double time = asked;
  for (int k = 0; k < most_halvings && !interrupted(k > 0 ? work : 0.0); ++k, time *= 0.5)
    if (resolves(from, nullptr, forces::resolution::span_of(time, largest_omega_), false))
      return time;
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
  if (!checks_.made_for(step, largest_omega_)) {
    checks_ = forces::resolution::Checks(step, largest_omega_);
    checked_.position.clear();
  }
  const forces::resolution::Span& half = checks_.half_a_step();
  const bool goes_on = checked_.position == from.position && checked_.velocity == from.velocity;
  if (!goes_on) {
    chain_ = {};
    if (!resolves(from, &to, half, false)) return describe_unresolved(from, step, half.time);
  }
  const auto at_end = [&](const forces::resolution::Span& span, bool ahead) {
    return resolves(to, &from, span, ahead);
  };
  const bool alone = !in_.forces->interacts() || bodies_.size() == 1;
  if (!(alone ? at_end(half, false) : checks_.at_end(chain_, at_end))) {
    checked_.position.clear();
    return describe_unresolved(to, step, half.time);
  }
  checked_ = to;
  return {};
}

std::string Group::describe_unresolved(const Phase<double>& at, double step, double radius) {
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
  char text[200];
  if (shorter > 0.0)
    std::snprintf(text, sizeof text,
                  "a step of %.3g does not resolve the forces near (%.6g, %.6g); there it may be "
                  "%.3g at most",
                  step, x.x, x.y, shorter);
  else
    std::snprintf(text, sizeof text,
                  "no step resolves the forces near (%.6g, %.6g), where they have no bound", x.x,
                  x.y);
  return text;
}

}  // namespace carom::events
