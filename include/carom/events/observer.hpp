// What an observer hears of the events in a world.
#pragma once

#include "carom/events/event.hpp"
#include "carom/motion/state.hpp"

namespace carom {

/// Receives what happens. Every function may be left alone. Observing changes no bit of an orbit:
/// an observer may ask the world for states, but must not add particles or remove them.
class Observer {
 public:
  virtual ~Observer() = default;
  virtual void hit(const HitEvent&) {}                          ///< a reflection, after it
  virtual void contact(const ContactEvent&) {}                  ///< of two hard discs
  virtual void sample(int /*particle*/, Time, const State&) {}  ///< state at the sample's time
  /// All samples of this time are given. False: the observer was interrupted over them. The run
  /// ends there as interrupted, and when it goes on it gives the samples of this time again.
  virtual bool sampled(Time) { return true; }
  /// A step has ended of a group that `particle` belongs to, not at a hit; `part`: a part of a
  /// step that was halved.
  virtual void stepped(int /*particle*/, Time, bool /*part*/) {}
  virtual void end(const EndEvent&) {}  ///< once, of a particle that has ended
  /// A crossing of the surface that is watched: the state there with its position in the plane
  /// (cell 0), and the direction, +1 or -1. Those of a flight come after the event that ends it.
  virtual void crossing(int /*particle*/, Time, const State&, int /*direction*/) {}
};

}  // namespace carom
