#include "growth.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/index.hpp"

namespace carom::page {

using base::at;

Growth::Growth(const System& system, const World& world)
    : world_(world), deviations_(system, engines::Deviations::two) {
  engines::refuse_no_deviations(system);
  std::vector<State> starts;
  std::vector<Particle> particles;
  for (int p = 0; p < world.size(); ++p) {
    starts.push_back(world.state(p));
    particles.push_back(world.particle(p));
  }
  deviations_.begin(starts, particles, engines::unit_length_of(*system.table));
}

void Growth::hit(const HitEvent& event) {
  deviations_.hit(at(event.particle), engines::state_after(event), world_, go_on_);
  last_ = event.time;
}

void Growth::contact(const ContactEvent& event) {
  deviations_.contact(event, go_on_);
  last_ = event.time;
}

void Growth::stepped(int particle, Time time, bool part) {
  if (!deviations_.takes_step(at(particle), part)) return;
  deviations_.stepped(at(particle), time, world_, go_on_);
  last_ = time;
}

double Growth::rate(std::size_t particle, double t) {
  if (!(t > 0.0) && last_ == Time()) return 0.0;
  // The double of a time may be a little earlier than the time.
  const double when = std::max(t, std::nextafter(last_.value(), no_last_time));
  return deviations_.logarithms(particle, when, go_on_)[0] / when;
}

}  // namespace carom::page
