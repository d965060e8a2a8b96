// Deviations of several free particles, exactly: by the maps of flights, hits and contacts.
#pragma once

#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "engines/group_tangent.hpp"

namespace carom::engines {

/// Each particle's part of the deviations is that of its own last event.
class FreeGroupTangent : public GroupTangent {
 public:
  FreeGroupTangent(const System& system, std::vector<std::size_t> members, Deviations deviations)
      : GroupTangent(system, std::move(members), deviations) {}

  void begin(std::span<const State> states, double unit) override;
  void fly_to(const Time&, const std::function<bool()>& stopped) override;
  void arrive(std::size_t particle, const Time&, const std::function<bool()>& stopped) override;
  void hit(std::size_t particle, const State&) override;
  void contact(const ContactEvent&) override;
  /// One of the deviations, over its length.
  Deviation direction(std::size_t particle, std::size_t deviation = 0) const {
    return at(deviation, member_of(particle));
  }

 private:
  void fly(std::size_t member, const Time&);
  Deviation at(std::size_t deviation, std::size_t member) const;
  void set(std::size_t deviation, std::size_t member, const Deviation&);
  /// A member has had an event.
  void settle(std::size_t member);

  std::vector<geometry::Vector> position_, velocity_;
  std::vector<Time> last_;  ///< of each member
  double unit_ = 1.0;
  std::size_t events_ = 0;  ///< since deviations were made orthogonal
};

}  // namespace carom::engines
