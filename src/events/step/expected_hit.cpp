// When the first hit within a step of several particles is to be expected.
//
// A step costs sums over all pairs. So it is not taken to its end first and cut afterwards, but to
// just behind the first hit, which is found with the particle alone: it is moved among the others,
// whose accelerations count as constant meanwhile, which costs one particle's pairs. What is found
// here chooses the length of a step that is searched like any other, and nothing else; it is a
// function of the phase alone, so that a run that goes on takes the same steps.
#include <algorithm>
#include <cmath>

#include "events/step/group.hpp"
#include "forces/nearest_copy.hpp"

namespace carom::events {

using geometry::Vector;

namespace {

/// How far behind the expected hit a step is led, in whole steps: that the hit is before its end,
/// and so near to it that the scheme's own step need not be taken once more.
constexpr double margin = 0x1p-17;

/// Where the gap along x + t v + t^2 a/2 falls to 0, from the last point on; `until` if it does not
/// fall, or the last point is inside.
double crossing(const Barrier<double>& b, Vector x, Vector v, Vector a, double until) {
  double t = until;
  for (int n = 0; n < 16; ++n) {
    const Vector there = x + t * (v + (0.5 * t) * a);
    const double gap = b.gap(there), rate = b.rate(there, v + t * a);
    if ((n == 0 && gap > 0.0) || !(rate < 0.0)) return until;
    const double next = t - gap / rate;
    if (std::fabs(next - t) <= 0x1p-40 * until) break;
    t = next;
  }
  return t > 0.0 && t < until && b.covers(x + t * (v + (0.5 * t) * a)) ? t : until;
}

}  // namespace

/// How far to take the step: to just behind the first hit, if one is expected in what is left of
/// it.
double Group::way_to_hit(double rest) {
  if (bodies_.size() == 1 || in_.barriers.empty() || !(rest > 0.0)) return rest;
  const std::span<const Vector> a = stepper_->at_start(phase_.position);
  if (a.empty()) return rest;
  struct Candidate {
    std::size_t member;
    const Barrier<double>* barrier;
    double about;
  };
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (interrupted(10.0 * static_cast<double>(in_.barriers.size()))) return rest;
    const Vector &x = phase_.position[i], &v = phase_.velocity[i];
    const Vector bend = a[i] + omega_[i] * right(v);
    const StepHull<double> hull(x, v, x + rest * (v + (0.5 * rest) * bend), v + rest * bend,
                                rest / 3.0);
    for (const Barrier<double>& b : in_.barriers) {
      if (is_edge(b) || stays_off(b, hull)) continue;
      const double about = crossing(b, x, v, bend, rest);
      if (about < rest) candidates.push_back({i, &b, about});
    }
  }
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& p, const Candidate& q) { return p.about < q.about; });
  double first = rest;
  for (const Candidate& c : candidates) {
    if (!(c.about < first)) break;
    first = std::min(first, refined_hit(c.member, *c.barrier, c.about, a));
  }
  return std::min(rest, first + margin * part_);
}

/// When that member crosses the barrier, by Runge and Kutta's steps of order 4 of it alone.
double Group::refined_hit(std::size_t member, const Barrier<double>& barrier, double about,
                          std::span<const Vector> a) const {
  const Particle& own = particles_[member];
  const Vector &x = phase_.position[member], &v = phase_.velocity[member];
  const auto acceleration = [&](double t, Vector there, Vector velocity) {
    Vector force{};
    in_.forces->add_external(own, there, force);
    for (std::size_t j = 0; j < particles_.size(); ++j) {
      if (j == member) continue;
      const Vector other =
          phase_.position[j] +
          t * (phase_.velocity[j] + (0.5 * t) * (a[j] + omega_[j] * right(phase_.velocity[j])));
      Vector d = there - other;
      if (in_.lattice) d = forces::nearest_copy(d, *in_.lattice);
      in_.forces->add_pair(own, particles_[j], d, force);
    }
    return (1.0 / own.mass) * force + omega_[member] * right(velocity);
  };
  double t = about;
  for (int n = 0; n < 3; ++n) {
    const double half = 0.5 * t;
    const Vector a1 = a[member] + omega_[member] * right(v);
    const Vector v2 = v + half * a1, a2 = acceleration(half, x + half * v, v2);
    const Vector v3 = v + half * a2, a3 = acceleration(half, x + half * v2, v3);
    const Vector v4 = v + t * a3, a4 = acceleration(t, x + t * v3, v4);
    const Vector there = x + (t / 6.0) * (v + 2.0 * v2 + 2.0 * v3 + v4),
                 velocity = v + (t / 6.0) * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
    const double late = barrier.gap(there) / barrier.rate(there, velocity);
    t -= late;
    if (!(t > 0.0)) return about;
    if (std::fabs(late) < 0.25 * margin * part_) break;
  }
  return t;
}

}  // namespace carom::events
