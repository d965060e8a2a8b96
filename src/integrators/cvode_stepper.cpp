#include "integrators/cvode_stepper.hpp"

#include <cvode/cvode.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include "carom/base/error.hpp"

namespace carom::integrators {
namespace {

/// After this many internal steps a chain begins anew: CVODE's clock runs on, and what it loses
/// to rounding would grow with it.
constexpr int longest_chain = 1000;
constexpr double far = std::numeric_limits<double>::max();

}  // namespace

CvodeStepper::CvodeStepper(const ForceLaw<double>& law, std::span<const double> omega,
                           double tolerance, double longest)
    : problem_(law, omega, tolerance), energy_(law, tolerance), longest_(longest) {
  N_VConst(0.0, problem_.state());
  memory_ = CVodeCreate(CV_ADAMS, problem_.context());
  if (memory_ == nullptr) throw InternalError("CVODE has no memory");
#if SUNDIALS_VERSION_MAJOR < 7
  CVodeSetErrHandlerFn(memory_, OdeProblem::no_message, nullptr);
#endif
  CVodeInit(memory_, OdeProblem::derivative, 0.0, problem_.state());
  CVodeSetUserData(memory_, &problem_);
  CVodeSetMaxErrTestFails(memory_, 20);
  CVodeWFtolerances(memory_, OdeProblem::weights);
  const SUNNonlinearSolver solver =
      SUNNonlinSol_FixedPoint(problem_.state(), 0, problem_.context());
  solver_ = solver;
  CVodeSetNonlinearSolver(memory_, solver);
}

CvodeStepper::~CvodeStepper() {
  CVodeFree(&memory_);
  SUNNonlinSolFree(static_cast<SUNNonlinearSolver>(solver_));
}

double CvodeStepper::step(const Phase<double>& from, double at_most, Phase<double>& to) {
  const bool again = same_bits(from, start_) && !same_bits(start_, end_);  // at rest time goes on
  if (!again) {
    if (same_bits(from, end_)) {
      std::swap(start_, end_);
      start_time_ = end_time_;
      if (start_time_ == reached_ && steps_ >= longest_chain) begin(start_, far);
    } else {
      start_ = from;
      problem_.set_scale(problem_.first_scale(from));
      reached_energy_ = energy_.at(start_);
      energy_.begin();
      begin(start_, far);
    }
    if (start_time_ == reached_) advance();
  }
  double duration = at_most, time = start_time_ + at_most;
  if (!(time < reached_)) {
    time = reached_;
    duration = reached_ - start_time_;
  }
  const bool ok =
      problem_.failure().empty() && CVodeGetDky(memory_, time, 0, problem_.state()) >= 0;
  problem_.unload(to, ok);
  if (!ok) return at_most;
  if (!again || time > end_time_) {
    end_ = to;
    end_time_ = time;
  }
  return duration;
}

void CvodeStepper::begin(const Phase<double>& from, double longest_first) {
  problem_.load(from);
  CVodeReInit(memory_, 0.0, problem_.state());
  planned_ = std::min({longest(), longest_first, problem_.first_step(from, 1)});
  stopped_ = false;
  CVodeSetMaxStep(memory_, longest());
  CVodeSetInitStep(memory_, planned_);
  start_time_ = reached_ = 0.0;
  steps_ = 0;
  problem_.set_failure({});
}

/// From the start, which the last internal step has reached.
void CvodeStepper::advance() {
  for (;;) {
    ++steps_;
    const double before = reached_;
    if (!take()) return;
    const double duration = reached_ - before, energy = energy_.at(ahead_);
    if (energy_.allows({start_, reached_energy_}, {ahead_, energy}, problem_.scale(), duration)) {
      reached_energy_ = energy;
      return;
    }
    if (problem_.scale().is_least(duration)) return problem_.set_failure(EnergyCheck::failure);
    begin(start_, 0.5 * duration);
  }
}

/// One internal step, as long as the forces allow. False: there is none.
bool CvodeStepper::take() {
  const double allowed = problem_.resolved(start_, planned_);
  if (!(allowed > 0.0)) return false;
  CVodeSetStopTime(memory_, stopped_ || allowed < planned_ ? reached_ + allowed : far);
  const double before = reached_;
  const int status = CVode(memory_, far, problem_.state(), &reached_, CV_ONE_STEP);
  problem_.rethrow();
  if (status < 0) problem_.set_failure(OdeProblem::no_step);
  if (status < 0 || !problem_.leads_on(reached_ - before)) return false;
  stopped_ = status == CV_TSTOP_RETURN;
  CVodeGetCurrentStep(memory_, &planned_);
  // After a stop CVODE keeps its plan to itself. A step is at most 10 times the last one, the
  // second 10000 times.
  if (stopped_) planned_ = std::min(longest(), (steps_ == 1 ? 1e4 : 10.0) * (reached_ - before));
  problem_.unload(ahead_, true);
  return true;
}

}  // namespace carom::integrators
