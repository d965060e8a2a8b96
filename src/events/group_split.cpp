// walls = "split": the walls belong to the drift of a splitting scheme. A drift is a flight among walls and
// nothing else; kicks come between, at once. For comparison only: see docs/physics/walls-in-steps.md.
#include <algorithm>

#include "carom/integrators/scheme.hpp"
#include "events/group.hpp"
#include "integrators/splitting.hpp"

namespace carom {

using geometry::Vector;
using Kind = Stage<double>::Kind;

namespace {

struct NoForce final : ForceLaw<double> {
  void accelerations(std::span<const Vector>, std::span<Vector> a) const override {
    std::fill(a.begin(), a.end(), Vector{});
  }
};
const NoForce no_force;

}  // namespace

/// The path is that of free particles, stepped as everything here: a step of a scheme without force.
void Group::make_drift() {
  if (!splits_) {
    splits_ = std::make_unique<Splits>();
    splits_->stages = stages_of<double>(find_scheme(in_.plan.scheme));
  }
  stepper_ = std::make_unique<SplittingStepper<double>>(find_scheme("velocity-verlet"), no_force, omega_);
  path_ = std::make_unique<StepPath<double>>(*stepper_, no_force, omega_);
}

void Group::kick(Phase<double>& phase, std::size_t first, std::size_t end) {
  for (std::size_t k = first; k < end; ++k) {
    if (splits_->position != phase.position) {
      splits_->position = phase.position;
      splits_->acceleration.resize(phase.position.size());
      accelerations(phase.position, splits_->acceleration);
    }
    const double duration = splits_->stages[k].coefficient * splits_->step;
    for (std::size_t i = 0; i < phase.velocity.size(); ++i)
      phase.velocity[i] = phase.velocity[i] + duration * splits_->acceleration[i];
  }
}

/// Where the next drift begins, or what a hit has left of one. phase() stays as it is, so that it is that
/// after whole steps when there is no step under way.
const Phase<double>& Group::begin_drift(const Time& limit) {
  Splits& s = *splits_;
  if (!s.under_way) {
    s.step_end = step_end(limit);
    s.step = s.step_end - time_;
    s.stage = 0;
    s.under_way = true;
  }
  if (s.in_drift) return phase_;
  s.kicked = phase_;
  const auto is_drift = [](const Stage<double>& stage) { return stage.kind == Kind::drift; };
  const auto from = s.stages.begin() + static_cast<std::ptrdiff_t>(s.stage);
  const auto drift = std::find_if(from, s.stages.end(), is_drift);
  kick(s.kicked, s.stage, static_cast<std::size_t>(drift - s.stages.begin()));
  const bool last = std::none_of(drift + 1, s.stages.end(), is_drift);
  path_end_ = last ? s.step_end : std::min(s.step_end, time_ + drift->coefficient * s.step);
  return s.kicked;
}

/// Within a step the kicks run ahead of the time or behind it. What is missing is made up for with the force
/// where the particle is, so that a state that is read there is that of a step that ends there, but for the
/// square of the step.
Vector Group::outstanding_kick(const Phase<double>& phase, std::size_t member, const Time& time) const {
  const Splits& s = *splits_;
  if (!s.under_way || (s.stage == 0 && !s.in_drift && !(time > time_))) return {};
  double given = 0.0;
  const bool ahead = s.in_drift || time > time_;  // the kicks before the drift under way count
  for (std::size_t k = 0; k < s.stages.size(); ++k) {
    if (k >= s.stage && (!ahead || s.stages[k].kind == Kind::drift)) break;
    if (s.stages[k].kind == Kind::kick) given += s.stages[k].coefficient * s.step;
  }
  std::vector<Vector> acceleration(phase.position.size());
  accelerations(phase.position, acceleration);
  return ((s.step - (s.step_end - time)) - given) * acceleration[member];
}

/// At a hit the drift goes on; else the next kicks come, and those after the last drift end the step.
void Group::end_drift() {
  Splits& s = *splits_;
  s.in_drift = next_.member >= 0;
  if (s.in_drift) return;
  while (s.stages[s.stage].kind != Kind::drift) ++s.stage;
  ++s.stage;
  const auto rest = s.stages.begin() + static_cast<std::ptrdiff_t>(s.stage);
  if (std::any_of(rest, s.stages.end(), [](const Stage<double>& stage) { return stage.kind == Kind::drift; })) return;
  kick(phase_, s.stage, s.stages.size());
  s.under_way = false;
}

}  // namespace carom
