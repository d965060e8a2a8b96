#include "integrators/arkode_stepper.hpp"

#include <arkode/arkode_arkstep.h>

#include <algorithm>

#include "carom/base/error.hpp"

namespace carom {

ArkodeStepper::Table ArkodeStepper::usual_table() { return {ARKODE_FEHLBERG_13_7_8, 8}; }

// ARKStep, not ERKStep: that one (6.4) takes the last stage for the next first one wherever it lies at the
// end of the step, and so loses the order of most tables.
ArkodeStepper::ArkodeStepper(const ForceLaw<double>& law, std::span<const double> omega, double tolerance,
                             Table table)
    : problem_(law, omega, tolerance), order_(table.order) {
  N_VConst(0.0, problem_.state());
  memory_ = ARKStepCreate(OdeProblem::derivative, nullptr, 0.0, problem_.state(), problem_.context());
  if (memory_ == nullptr) throw InternalError("ARKODE has no memory");
  ARKStepSetErrHandlerFn(memory_, OdeProblem::no_message, nullptr);
  ARKStepSetUserData(memory_, &problem_);
  ARKStepSetTableNum(memory_, ARKODE_DIRK_NONE, static_cast<ARKODE_ERKTableID>(table.id));
  ARKStepWFtolerances(memory_, OdeProblem::weights);
  ARKStepSetAdaptivityMethod(memory_, ARK_ADAPT_I, 1, 0, nullptr);  // each step stands alone
  ARKStepSetMaxFirstGrowth(memory_, 5.0);
  ARKStepSetMaxErrTestFails(memory_, 20);
}

ArkodeStepper::~ArkodeStepper() { ARKStepFree(&memory_); }

double ArkodeStepper::step(const Phase<double>& from, double at_most, Phase<double>& to) {
  if (same_bits(from, start_) && !same_bits(start_, end_)) {  // at rest time goes on
    if (at_most < duration_) {
      part(at_most, to);
      return at_most;
    }
    if (at_most > asked_ && duration_ == asked_) whole(at_most);
  } else {
    if (same_bits(from, end_)) {
      std::swap(start_, end_);
      scale_ = problem_.scale();
      guess_ = proposed_;
    } else {
      start_ = from;
      scale_ = problem_.first_scale(from);
      problem_.set_scale(scale_);
      guess_ = problem_.first_step(from, order_);
    }
    whole(at_most);
  }
  to = end_;
  return duration_;
}

void ArkodeStepper::part(double duration, Phase<double>& to) {
  const OdeProblem::Scale kept = problem_.scale();
  problem_.load(start_);
  ARKStepReInit(memory_, OdeProblem::derivative, nullptr, 0.0, problem_.state());
  ARKStepSetFixedStep(memory_, duration);
  double reached = 0.0;
  const int status = ARKStepEvolve(memory_, duration, problem_.state(), &reached, ARK_ONE_STEP);
  ARKStepSetFixedStep(memory_, 0.0);
  problem_.rethrow();
  problem_.set_failure(status < 0 ? OdeProblem::no_step : std::string_view());
  problem_.unload(to, status >= 0);
  problem_.set_scale(kept);
}

void ArkodeStepper::whole(double at_most) {
  asked_ = at_most;
  if (at_most < guess_ / 1024.0) {  // its error is nothing, and ARKODE's checks fear so short a way
    part(at_most, end_);
    duration_ = at_most;
    proposed_ = guess_;
    return;
  }
  problem_.load(start_);
  problem_.set_scale(scale_);
  ARKStepReInit(memory_, OdeProblem::derivative, nullptr, 0.0, problem_.state());
  ARKStepSetInitStep(memory_, std::min(guess_, at_most));
  ARKStepSetStopTime(memory_, at_most);
  const int status = ARKStepEvolve(memory_, at_most, problem_.state(), &duration_, ARK_ONE_STEP);
  problem_.rethrow();
  problem_.set_failure(status < 0 ? OdeProblem::no_step : std::string_view());
  const bool ok = status >= 0 && (duration_ == at_most || problem_.leads_on(duration_));
  problem_.unload(end_, ok);
  if (!ok) duration_ = at_most;
  // A step cut short by who asks says little about the next one.
  ARKStepGetCurrentStep(memory_, &proposed_);
  if (duration_ == at_most) proposed_ = std::max(proposed_, guess_);
  proposed_ = std::min(proposed_, problem_.longest_step());
}

}  // namespace carom
