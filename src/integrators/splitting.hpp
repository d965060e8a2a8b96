// Splitting schemes: one loop over the motions of a step.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "carom/integrators/scheme.hpp"
#include "carom/integrators/stepper.hpp"
#include "integrators/evaluated_forces.hpp"
#include "integrators/larmor_drift.hpp"
#include "integrators/per_particle.hpp"
#include "integrators/stages.hpp"

namespace carom::integrators {

template <class Real>
class SplittingStepper final : public Stepper<Real> {
 public:
  using Vector = geometry::BasicVector<Real>;
  using Kind = typename Stage<Real>::Kind;

  /// `omega`: one entry a particle. Refers to `law`.
  SplittingStepper(const Scheme& scheme, const ForceLaw<Real>& law, std::span<const Real> omega)
      : stages_(stages_of<Real>(scheme)),
        law_(law),
        known_(law),
        drifts_(omega),
        scratch_(omega.size()) {}

  Real step(const Phase<Real>& from, Real time, Phase<Real>& to) override {
    to = from;
    const std::vector<LarmorDrift<Real>>& drifts =
        drifts_.of_step(time, [&](const Real& omega, std::vector<LarmorDrift<Real>>& list) {
          for (const Stage<Real>& s : stages_) list.emplace_back(omega, s.coefficient * time);
        });
    std::span<const Vector> acceleration;  // at the present positions; empty when they have changed
    const std::size_t n = to.position.size();
    for (std::size_t k = 0; k < stages_.size(); ++k) {
      const Stage<Real>& stage = stages_[k];
      if (stage.kind == Kind::kick) {
        if (acceleration.empty()) acceleration = accelerations(k, to.position);
        const Real duration = stage.coefficient * time;
        for (std::size_t i = 0; i < n; ++i)
          to.velocity[i] = to.velocity[i] + duration * acceleration[i];
        continue;
      }
      if (stage.kind == Kind::straight) {
        const Real duration = stage.coefficient * time;
        for (std::size_t i = 0; i < n; ++i)
          to.position[i] = to.position[i] + duration * to.velocity[i];
        acceleration = {};
        continue;
      }
      for (std::size_t i = 0; i < n; ++i) {
        const LarmorDrift<Real>& drift = drifts[drifts_.entry_of(i) * stages_.size() + k];
        if (stage.kind == Kind::turn) {
          drift.turn(to.velocity[i]);
        } else {
          drift.move(to.position[i], to.velocity[i]);
        }
      }
      if (stage.kind == Kind::drift) acceleration = {};
    }
    return time;
  }

  std::span<const Vector> at_start(std::span<const Vector> position) override {
    if (stages_.front().kind != Kind::kick) return {};
    return known_.at_start(position);
  }
  std::span<const Vector> remembered(std::span<const Vector> position) const override {
    return known_.remembered_anywhere(position);
  }
  void forget() override { known_.forget(); }

 private:
  std::span<const Vector> accelerations(std::size_t stage, std::span<const Vector> position) {
    if (stage == 0) return known_.at_start(position);
    if (stage + 1 == stages_.size()) return known_.at_end(position);
    law_.accelerations(position, scratch_);
    return scratch_;
  }

  std::vector<Stage<Real>> stages_;
  const ForceLaw<Real>& law_;
  EvaluatedForces<Real> known_;
  PerParticle<Real, LarmorDrift<Real>> drifts_;
  std::vector<Vector> scratch_;
};

}  // namespace carom::integrators
