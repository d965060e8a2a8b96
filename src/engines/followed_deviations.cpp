#include "engines/followed_deviations.hpp"

#include <cmath>
#include <numeric>
#include <utility>

#include "base/index.hpp"
#include "carom/base/error.hpp"
#include "carom/integrators/scheme.hpp"
#include "carom/starts/injection.hpp"
#include "carom/table/table.hpp"
#include "engines/force_tangent.hpp"
#include "engines/free_group_tangent.hpp"

namespace carom::engines {

using base::at;

void refuse_no_deviations(const System& system) {
  if (system.is_integrated() && is_adaptive(system.dynamics.integrator.scheme))
    throw InputError(Place{"", 0, 0, "integrator.scheme"},
                     "deviations are not followed by adaptive schemes", "a scheme of fixed steps");
  refuse_all_but_mirrors(*system.table, "deviations");
  refuse_injections(system, "an ensemble whose deviations grow");
}

double unit_length_of(const Table& table) {
  const TableMeasure size = measure(table);
  const double length = std::isfinite(size.mean_flight) ? size.mean_flight : size.perimeter;
  return length > 0.0 ? length : 1.0;
}

State state_after(const HitEvent& event) {
  State state;
  state.wall = event.wall;
  state.u = event.u;
  state.position = event.position;
  state.velocity = event.after;
  state.cell = event.cell;
  state.time = event.time;
  return state;
}

FollowedDeviations::FollowedDeviations(const System& system, Deviations kind)
    : system_(system),
      kind_(kind),
      walls_(motion::tangent_walls(system.table->walls, system.table->lattice)) {
  if (!system.has_forces() && !system.of_discs() && kind != Deviations::frame)
    return;  // across their orbits
  std::vector<std::size_t> all(system.particles.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  if (act_on_each_other(system))
    add_group(std::move(all));
  else
    for (const std::size_t p : all) add_group({p});
}

void FollowedDeviations::add_group(std::vector<std::size_t> members) {
  if (system_.has_forces())
    groups_.push_back(std::make_unique<ForceTangent>(system_, std::move(members), kind_));
  else
    groups_.push_back(std::make_unique<FreeGroupTangent>(system_, std::move(members), kind_));
}

void FollowedDeviations::begin(std::span<const State> starts, std::span<const Particle> particles,
                               double unit_length) {
  in_parts_ = false;
  members_.assign(starts.size(), {});
  for (std::size_t p = 0; p < members_.size(); ++p)
    members_[p].tangent.begin(starts[p], particles[p], unit_length);
  for (const auto& group : groups_) {
    const geometry::Vector v = starts[group->members().front()].velocity;
    const double speed = std::sqrt(dot(v, v));
    group->begin(starts, unit_length / (speed > 0.0 ? speed : 1.0));
    for (const std::size_t p : group->members()) members_[p].group = group.get();
  }
}

std::size_t FollowedDeviations::reported_with(std::size_t particle) const {
  const GroupTangent* const group = members_[particle].group;
  return group ? group->members().front() : particle;
}

void FollowedDeviations::hit(std::size_t particle, const State& state, const World& world,
                             const Stopped& stopped) {
  GroupTangent* const group = members_[particle].group;
  if (!group) return members_[particle].tangent.hit(walls_, state);
  group->arrive(particle, state.time, stopped);
  put_back(*group, world, state.time);
  group->hit(particle, state);
}

void FollowedDeviations::contact(const ContactEvent& event, const Stopped& stopped) {
  GroupTangent* const group = members_[at(event.first)].group;
  for (const int p : {event.first, event.second}) group->arrive(at(p), event.time, stopped);
  group->contact(event);
}

bool FollowedDeviations::takes_step(std::size_t particle, bool part) {
  in_parts_ = in_parts_ || part;
  return in_parts_ && in_group(particle);
}

void FollowedDeviations::stepped(std::size_t particle, const Time& time, const World& world,
                                 const Stopped& stopped) {
  GroupTangent& group = *members_[particle].group;
  group.arrive(particle, time, stopped);
  put_back(group, world, time);
}

/// The path of a chaotic group leaves that of the world by its rounding: it is brought back.
void FollowedDeviations::put_back(GroupTangent& group, const World& world, const Time& time) {
  for (const std::size_t p : group.members())
    if (const State other = world.state(static_cast<int>(p)); other.time == time)
      group.put(p, other);
}

std::span<const double> FollowedDeviations::logarithms(std::size_t particle, double time,
                                                       const Stopped& stopped) {
  GroupTangent* const group = members_[particle].group;
  if (group) group->fly_to(time, stopped);
  if (group && kind_ == Deviations::frame) return group->logarithms();
  if (group)
    pair_ = {group->logarithms()[0], group->logarithms()[0]};
  else
    pair_ = members_[particle].tangent.logarithms(time);
  return pair_;
}

}  // namespace carom::engines
