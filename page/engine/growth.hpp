// How deviations of a flight's particles grow: the colour of an orbit by its exponent.
#pragma once

#include <functional>

#include "carom/events/observer.hpp"
#include "carom/events/world.hpp"
#include "engines/followed_deviations.hpp"

namespace carom::page {

/// Hears what happens in a world, or is told. Throws InputError where deviations cannot be
/// followed.
class Growth final : public Observer {
 public:
  /// From the states that the world's particles have. Refers to both.
  Growth(const System&, const World&);

  void hit(const HitEvent&) override;
  void contact(const ContactEvent&) override;
  void stepped(int particle, Time, bool part) override;
  /// ln of the length of a deviation that was 1 at the start, over the time since; at time t, or at
  /// the last event if that is later. As `carom lyapunov` with a window from 0.
  double rate(std::size_t particle, double t);

 private:
  const World& world_;
  engines::FollowedDeviations deviations_;
  Time last_;
  const std::function<bool()> go_on_;
};

}  // namespace carom::page
