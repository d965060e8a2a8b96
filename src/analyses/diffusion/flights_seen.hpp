// The free flights of one particle, as they come.
#pragma once

#include <algorithm>
#include <limits>
#include <utility>

#include "carom/analyses/diffusion/free_paths.hpp"
#include "carom/base/time.hpp"
#include "carom/engines/engine.hpp"
#include "carom/system/system.hpp"

namespace carom::analyses {

/// Flights that begin at a hit until a time `half`, half of the run: whatever becomes of them, each
/// is seen for at least as long again.
class FlightsSeen {
 public:
  void hit(const Time& time, double speed, double half) {
    add(speed * (time - last_), half);
    last_ = time;
    started_ = true;
  }

  FlightsOfParticle end(const ParticleEnd& end, double speed, double half) {
    seen_.hits = end.hits;
    if (end.fate != Fate::pinned) seen_.path = speed * end.time;
    // A hole is a piece of wall; a particle still in flight, or gone for good, flies on.
    if (end.fate == Fate::escaped)
      add(speed * (Time(end.time) - last_), half);
    else if (end.fate == Fate::survived || end.fate == Fate::unbounded)
      add(std::numeric_limits<double>::infinity(), half);
    return std::move(seen_);
  }

 private:
  void add(double length, double half) {
    if (!started_)
      seen_.at_start.push_back(length);
    else if (!(last_ > Time(half)))
      seen_.between.push_back(length);
  }

  FlightsOfParticle seen_;
  Time last_;
  bool started_ = false;  ///< was there a hit?
};

/// Up to which all flights are seen, the slowest particle's, too.
inline double longest_path(const System& system) {
  double slowest = std::numeric_limits<double>::infinity();
  for (const Particle& particle : system.particles) slowest = std::min(slowest, particle.speed);
  return slowest * (system.run.times.back() / 2);
}

}  // namespace carom::analyses
