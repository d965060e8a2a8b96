// Does a step resolve the forces that it crosses? forces/resolution.hpp has the criterion.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "carom/integrators/scheme.hpp"
#include "events/group.hpp"
#include "forces/nearest_copy.hpp"

namespace carom {

using geometry::Vector;

namespace {

double length(const Vector& a) { return std::sqrt(dot(a, a)); }

}  // namespace

void Group::find_maps() {
  maps_.clear();
  if (in_.maps == nullptr) return;
  for (const Particle& p : particles_) maps_.push_back(&in_.maps->of(p));
}

/// Is the motion from there analytic for complex times up to `time`? `to`: where a step has led from it, a hint.
bool Group::resolves(const Phase<double>& from, const Phase<double>* to, double time) const {
  if (maps_.empty() || !(time > 0.0)) return true;
  if (in_.forces->interacts() && bodies_.size() > 1) return resolves_pairs(from, time);
  for (std::size_t i = 0; i < maps_.size(); ++i) {
    const double speed = length(from.velocity[i]);
    double way = speed * time;
    if (to) {
      way = 0.5 * length(to->position[i] - from.position[i]);
    } else {
      Vector force{};
      in_.forces->add_external(particles_[i], from.position[i], force);
      way += 0.5 * length(force) / particles_[i].mass * time * time;
    }
    if (!maps_[i]->resolves(from.position[i], speed, way, time)) return false;
  }
  return true;
}

/// Where particles interact, every one is displaced while the others are.
bool Group::resolves_pairs(const Phase<double>& from, double time) const {
  const ForceField& forces = *in_.forces;
  const std::size_t n = maps_.size();
  std::vector<double> rho(n, 0.0), acceleration(n), jump(n);
  const auto bound = [&] {
    for (std::size_t i = 0; i < n; ++i) {
      const ForceBound external = forces.external() ? maps_[i]->about(from.position[i], rho[i]) : ForceBound{};
      acceleration[i] = external.force;
      jump[i] = external.jump;
    }
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < i; ++j) {
        Vector d = from.position[i] - from.position[j];
        if (in_.lattice) d = nearest_copy(d, *in_.lattice);
        const ForceBound pair = forces.pair_bound(particles_[i], particles_[j], length(d), rho[i] + rho[j]);
        acceleration[i] += pair.force / particles_[i].mass;
        acceleration[j] += pair.force / particles_[j].mass;
        jump[i] += pair.jump / particles_[i].mass;
        jump[j] += pair.jump / particles_[j].mass;
      }
  };
  bound();  // of the forces at the real positions
  std::vector<double> growth(n), speed(n);
  for (std::size_t i = 0; i < n; ++i) {
    growth[i] = resolution::growth(particles_[i].omega, time);
    speed[i] = length(from.velocity[i]);
    rho[i] = 2.0 * growth[i] * time * (speed[i] + 0.5 * acceleration[i] * time);
  }
  bound();
  for (std::size_t i = 0; i < n; ++i) {
    if (!resolution::stays(speed[i], acceleration[i], time, growth[i], rho[i])) return false;
    if (jump[i] > 0.0 && !(jump[i] * resolution::steps_a_radius * time <= resolution::kick_share * speed[i]))
      return false;
  }
  return true;
}

/// The longest of asked, asked/2, asked/4, ... that resolves the forces from there on; 0 if none does.
double Group::longest_resolved(const Phase<double>& from, double asked) const {
  constexpr int most_halvings = 60;
  for (int k = 0; k < most_halvings; ++k, asked *= 0.5)
    if (resolves(from, nullptr, asked)) return asked;
  return 0.0;
}

/// Whether the step under way, from phase_ to the path's end, resolves the forces; if not, why.
std::string_view Group::check_resolution() {
  if (maps_.empty()) return {};
  const Phase<double>&from = path_->start().phase, &to = path_->end().phase;
  // Adaptive schemes ask for the longest step before they take it.
  const bool adaptive = is_adaptive(in_.plan.scheme);
  const double time = adaptive ? path_->end().time : path_->end().time / resolution::steps_a_radius;
  const bool known = checked_for_ == time && checked_.position == from.position && checked_.velocity == from.velocity;
  const bool from_start = known || resolves(from, adaptive ? nullptr : &to, time);
  if (from_start && (adaptive || resolves(to, &from, time))) {
    checked_ = to;
    checked_for_ = time;
    return {};
  }
  checked_for_ = 0.0;
  const Phase<double>& at = from_start ? to : from;
  const double shorter = path_->end().time / time * longest_resolved(at, time);
  std::size_t member = 0;  // the one that is to blame, where particles do not interact
  while (member + 1 < maps_.size() && maps_[member]->resolves(at.position[member], length(at.velocity[member]),
                                                              length(at.velocity[member]) * time, time))
    ++member;
  char text[200];
  if (shorter > 0.0)
    std::snprintf(text, sizeof text,
                  "a step of %.3g does not resolve the forces near (%.6g, %.6g); there it may be %.3g at most",
                  path_->end().time, at.position[member].x, at.position[member].y, shorter);
  else
    std::snprintf(text, sizeof text, "no step resolves the forces near (%.6g, %.6g), where they have no bound",
                  at.position[member].x, at.position[member].y);
  fault_text_ = text;
  return fault_text_;
}

}  // namespace carom
