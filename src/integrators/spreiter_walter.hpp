// The scheme of Spreiter & Walter (1999): the motion under magnetic field and a force that is
// frozen for the positions, and goes linearly from its old to its new value for the velocities.
// Without field it is velocity Verlet. Formulas: docs/physics/integrators.md.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "carom/integrators/stepper.hpp"
#include "integrators/evaluated_forces.hpp"
#include "integrators/larmor_drift.hpp"
#include "integrators/per_particle.hpp"

namespace carom::integrators {

/// (theta - sin theta)/theta^2, odd in theta. Its series for |theta| < 1, where the difference
/// cancels; both are good to rounding there.
template <class Real>
Real sine_deficit(const Real& theta) {
  const Real square = theta * theta;
  if (!(square < Real(1))) return (theta - Arithmetic<Real>::turn(theta).sine) / square;
  Real term = theta / Real(6), sum = term;
  for (int k = 4;; k += 2) {
    term = -(term * square / Real(k * (k + 1)));
    const Real next = sum + term;
    if (next == sum) return sum;
    sum = next;
  }
}

/// The linear map parallel + across J.
template <class Real>
struct TurnAndStretch {
  Real parallel{}, across{};
  geometry::BasicVector<Real> operator()(const geometry::BasicVector<Real>& a) const {
    return parallel * a + across * right(a);
  }
};

template <class Real>
class SpreiterWalterStepper final : public Stepper<Real> {
 public:
  using Vector = geometry::BasicVector<Real>;

  SpreiterWalterStepper(const ForceLaw<Real>& law, std::span<const Real> omega)
      : known_(law), motions_(omega) {}

  Real step(const Phase<Real>& from, Real time, Phase<Real>& to) override {
    to = from;
    const std::vector<Motion>& motions = motions_.of_step(
        time,
        [&](const Real& omega, std::vector<Motion>& list) { list.push_back(motion(omega, time)); });
    const std::span<const Vector> before = known_.at_start(from.position);
    const std::size_t n = to.position.size();
    for (std::size_t i = 0; i < n; ++i) {
      const Motion& m = motions[motions_.entry_of(i)];
      Vector along = from.velocity[i];
      to.position[i] = to.position[i] + time * (m.once(along) + time * m.twice(before[i]));
    }
    const std::span<const Vector> after = known_.at_end(to.position);
    for (std::size_t i = 0; i < n; ++i) {
      const Motion& m = motions[motions_.entry_of(i)];
      m.free.turn(to.velocity[i]);
      to.velocity[i] = to.velocity[i] + time * (m.once(before[i]) + m.twice(after[i] - before[i]));
    }
    return time;
  }

 private:
  struct Motion {
    LarmorDrift<Real> free;
    TurnAndStretch<Real> once,
        twice;  ///< mean of the turns by omega s, 0 <= s <= t; and their mean again
  };

  static Motion motion(const Real& omega, const Real& time) {
    const Real theta = omega * time, half = theta / Real(2);
    Motion m{LarmorDrift<Real>(omega, time), {Real(1), Real(0)}, {Real(1) / Real(2), Real(0)}};
    if (half == Real(0)) return m;
    const SineCosine<Real> turn = Arithmetic<Real>::turn(half);
    const Real chord = turn.sine / half;
    m.once = {chord * turn.cosine, chord * turn.sine};
    m.twice = {chord * chord / Real(2), sine_deficit(theta)};
    return m;
  }

  EvaluatedForces<Real> known_;
  PerParticle<Real, Motion> motions_;
};

}  // namespace carom::integrators
