// Deviations of all particles of a trajectory, carried along by the events of its world.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "carom/events/event.hpp"
#include "carom/events/world.hpp"
#include "carom/system/system.hpp"
#include "engines/group_tangent.hpp"
#include "motion/free_tangent.hpp"

namespace carom::engines {

/// Throws InputError where deviations cannot be followed.
void refuse_no_deviations(const System&);
/// Lengths and rates of deviations are compared by the time that a particle needs for this length:
/// the mean flight, or where there is none the walls' length or 1.
double unit_length_of(const Table&);
/// In which a particle leaves the wall.
State state_after(const HitEvent&);

/// Exactly across the orbit of a particle that is free and alone, else those of its group.
/// `stopped`, asked now and then, ends what takes long by SamplingStopped.
class FollowedDeviations {
 public:
  using Stopped = std::function<bool()>;

  /// Refers to the system. `kind`: of groups.
  FollowedDeviations(const System&, Deviations kind);

  /// Of particles that start so.
  void begin(std::span<const State> starts, std::span<const Particle>, double unit_length);
  bool begun() const { return !members_.empty(); }
  /// The first member of a particle's group, with which the group is reported; itself, if alone.
  std::size_t reported_with(std::size_t particle) const;
  bool in_group(std::size_t particle) const { return members_[particle].group != nullptr; }

  /// A particle leaves a wall in this state.
  void hit(std::size_t particle, const State&, const World&, const Stopped&);
  void contact(const ContactEvent&, const Stopped&);
  /// Does `stepped` have something to do? `part`: of a step that was halved. Deviations fly beside
  /// the world, with the plan's steps. Once these were halved they take the world's.
  bool takes_step(std::size_t particle, bool part);
  void stepped(std::size_t particle, const Time&, const World&, const Stopped&);

  /// Logarithms of the lengths at a time that is not before the last event: two, or those of a
  /// frame. Of two in a group, which are made orthogonal, the first one's length is that of both,
  /// as it is where all turn into one direction. Valid until the next call.
  std::span<const double> logarithms(std::size_t particle, double time, const Stopped&);

 private:
  void add_group(std::vector<std::size_t> members);
  void put_back(GroupTangent&, const World&, const Time&);

  struct Member {
    motion::FreeTangent tangent;
    GroupTangent* group = nullptr;
  };
  const System& system_;
  const Deviations kind_;
  motion::TangentWalls walls_;
  std::vector<std::unique_ptr<GroupTangent>> groups_;
  std::vector<Member> members_;  ///< one a particle
  std::array<double, 2> pair_{};
  bool in_parts_ = false;  ///< a step of this trajectory was halved
};

}  // namespace carom::engines
