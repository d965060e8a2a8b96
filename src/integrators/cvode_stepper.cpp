#include "integrators/cvode_stepper.hpp"

#include <cvode/cvode.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <algorithm>
#include <limits>

#include "carom/base/error.hpp"

namespace carom {
namespace {

/// After so many internal steps a chain begins anew: CVODE's clock runs on, and what it loses
/// to rounding would grow with it.
constexpr int longest_chain = 1000;

}  // namespace

CvodeStepper::CvodeStepper(const ForceLaw<double>& law, std::span<const double> omega, double tolerance,
                           double longest)
    : problem_(law, omega, tolerance), longest_(longest) {
  N_VConst(0.0, problem_.state());
  memory_ = CVodeCreate(CV_ADAMS, problem_.context());
  if (memory_ == nullptr) throw InternalError("CVODE has no memory");
  CVodeSetErrHandlerFn(memory_, OdeProblem::no_message, nullptr);
  CVodeInit(memory_, OdeProblem::derivative, 0.0, problem_.state());
  CVodeSetUserData(memory_, &problem_);
  CVodeSetMaxErrTestFails(memory_, 20);
  CVodeWFtolerances(memory_, OdeProblem::weights);
  const SUNNonlinearSolver solver = SUNNonlinSol_FixedPoint(problem_.state(), 0, problem_.context());
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
      if (start_time_ == reached_ && steps_ >= longest_chain) begin(start_);
    } else {
      start_ = from;
      problem_.set_scale(problem_.first_scale(from));
      begin(start_);
    }
    if (start_time_ == reached_) advance();
  }
  double duration = at_most, time = start_time_ + at_most;
  if (!(time < reached_)) {
    time = reached_;
    duration = reached_ - start_time_;
  }
  const bool ok = problem_.failure().empty() && CVodeGetDky(memory_, time, 0, problem_.state()) >= 0;
  problem_.unload(to, ok);
  if (!ok) return at_most;
  if (!again || time > end_time_) {
    end_ = to;
    end_time_ = time;
  }
  return duration;
}

void CvodeStepper::begin(const Phase<double>& from) {
  problem_.load(from);
  CVodeReInit(memory_, 0.0, problem_.state());
  const double longest = std::min(longest_, problem_.longest_step());
  CVodeSetMaxStep(memory_, longest);
  CVodeSetInitStep(memory_, std::min(longest, problem_.first_step(from, 1)));
  start_time_ = reached_ = 0.0;
  steps_ = 0;
  problem_.set_failure({});
}

void CvodeStepper::advance() {
  ++steps_;
  const double before = reached_;
  const double ahead = std::numeric_limits<double>::max();  // one step, as far as it goes
  const int status = CVode(memory_, ahead, problem_.state(), &reached_, CV_ONE_STEP);
  problem_.rethrow();
  if (status < 0) problem_.set_failure(OdeProblem::no_step);
  problem_.leads_on(reached_ - before);
}

}  // namespace carom
