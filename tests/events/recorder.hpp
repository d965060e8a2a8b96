// Particles for the tests of the event loop, and an observer that records their events.
#pragma once

#include <utility>
#include <vector>

#include "carom/events/world.hpp"
#include "tables_by_hand.hpp"

namespace carom::tests {

inline State start(Vector position, Vector velocity) {
  State s;
  s.position = position;
  s.velocity = velocity;
  return s;
}
inline Particle particle(double omega = 0.0, double speed = 1.0) {
  Particle p;
  p.omega = omega;
  p.speed = speed;
  return p;
}

/// Keeps everything it is told.
struct Recorder : Observer {
  std::vector<HitEvent> hits;
  std::vector<std::pair<double, State>> samples;
  std::vector<EndEvent> ends;
  void hit(const HitEvent& e) override { hits.push_back(e); }
  void sample(int, Time t, const State& s) override { samples.emplace_back(t.value(), s); }
  void end(const EndEvent& e) override { ends.push_back(e); }
};

}  // namespace carom::tests
