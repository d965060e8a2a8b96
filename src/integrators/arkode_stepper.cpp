#include "integrators/arkode_stepper.hpp"

#include <arkode/arkode_arkstep.h>

#include <algorithm>
#include <memory>
#include <string_view>
#include <vector>

#include "carom/base/error.hpp"
#include "carom/integrators/arithmetic.hpp"
#include "integrators/embedded_table.hpp"

// From 7.1 on these functions have a second name, which 6 does not know.
#pragma GCC diagnostic ignored "-Wdeprecated-declarations"

namespace carom::integrators {

namespace {

struct FreeTable {
  void operator()(ARKodeButcherTable table) const { ARKodeButcherTable_Free(table); }
};
using OwnTable = std::unique_ptr<ARKodeButcherTableMem, FreeTable>;

OwnTable table_of(const EmbeddedTable& from) {
  const auto numbers = [](const std::vector<std::string_view>& decimals) {
    std::vector<double> list;
    for (const std::string_view text : decimals) list.push_back(Arithmetic<double>::parse(text));
    return list;
  };
  const std::size_t stages = from.time.size();
  std::vector<double> time = numbers(from.time), weight = numbers(from.weight),
                      embedded = numbers(from.embedded), a;
  for (const std::vector<std::string_view>& row : from.stage) {
    std::vector<double> values = numbers(row);
    values.resize(stages, 0.0);
    a.insert(a.end(), values.begin(), values.end());
  }
  return OwnTable(ARKodeButcherTable_Create(static_cast<int>(stages), from.order,
                                            from.embedded_order, time.data(), a.data(),
                                            weight.data(), embedded.data()));
}

}  // namespace

// ARKStep, not ERKStep: that one (6.4) takes the last stage for the next first one wherever it lies
// at the end of the step, and so loses the order of most tables.
ArkodeStepper::ArkodeStepper(const ForceLaw<double>& law, std::span<const double> omega,
                             double tolerance, ARKodeButcherTable table)
    : problem_(law, omega, tolerance), energy_(law, tolerance) {
  OwnTable own;
  if (table == nullptr) {
    own = table_of(verner_9_8());
    table = own.get();
  }
  if (table == nullptr) throw InternalError("ARKODE has no memory");
  order_ = table->q;
  N_VConst(0.0, problem_.state());
  memory_ =
      ARKStepCreate(OdeProblem::derivative, nullptr, 0.0, problem_.state(), problem_.context());
  if (memory_ == nullptr) throw InternalError("ARKODE has no memory");
#if SUNDIALS_VERSION_MAJOR < 7
  ARKStepSetErrHandlerFn(memory_, OdeProblem::no_message, nullptr);
#endif
  ARKStepSetUserData(memory_, &problem_);
  ARKStepSetTables(memory_, table->q, table->p, nullptr, table);  // which copies it
  ARKStepWFtolerances(memory_, OdeProblem::weights);
  ARKStepSetAdaptivityMethod(memory_, ARK_ADAPT_I, 1, 0, nullptr);  // each step is independent
  ARKStepSetMaxFirstGrowth(memory_, 5.0);
  ARKStepSetMaxErrTestFails(memory_, 20);
}

ArkodeStepper::~ArkodeStepper() { ARKStepFree(&memory_); }

double ArkodeStepper::step(const Phase<double>& from, double at_most, Phase<double>& to) {
  if (same_bits(from, start_) && !same_bits(start_, end_)) {  // at rest time goes on
    if (at_most < duration_) {
      part(at_most, to);
      if (!failure().empty()) return at_most;
      if (energy_.allows_part({start_, start_energy_}, {to, energy_.at(to)}, scale_, at_most))
        return at_most;
      problem_.set_failure("the energy is not kept within a step: its stages have missed a force");
      problem_.unload(to, false);
      return at_most;
    }
    if (at_most > asked_ && duration_ == asked_) whole(at_most);
  } else {
    if (same_bits(from, end_)) {
      std::swap(start_, end_);
      start_energy_ = end_energy_;
      scale_ = problem_.scale();
      guess_ = proposed_;
    } else {
      start_ = from;
      start_energy_ = energy_.at(start_);
      energy_.begin();
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
  problem_.set_scale(scale_);
  problem_.set_failure({});
  bool ok = true;
  for (double length = problem_.resolved(start_, std::min(guess_, at_most));;
       length = 0.5 * duration_) {
    ok = length > 0.0 && take(length, at_most);
    if (!ok) break;
    end_energy_ = energy_.at(end_);
    if (energy_.allows({start_, start_energy_}, {end_, end_energy_}, problem_.scale(), duration_))
      break;
    ok = !scale_.is_least(duration_);
    if (!ok) problem_.set_failure(EnergyCheck::failure);
    if (!ok) break;
  }
  problem_.unload(end_, ok);
  if (!ok) duration_ = at_most;
  // A step cut short by the caller says little about the next one.
  if (duration_ == at_most) proposed_ = std::max(proposed_, guess_);
  proposed_ = std::min(proposed_, problem_.longest_step());
}

/// From start to end, by `length` or as little as the error control wants. False: there is no such
/// step.
bool ArkodeStepper::take(double length, double at_most) {
  if (length == at_most &&
      at_most < guess_ / 1024.0) {  // its error is nothing, and ARKODE's checks fear so short a way
    part(at_most, end_);
    duration_ = at_most;
    proposed_ = guess_;
    return problem_.failure().empty();
  }
  problem_.load(start_);
  problem_.set_scale(scale_);
  ARKStepReInit(memory_, OdeProblem::derivative, nullptr, 0.0, problem_.state());
  ARKStepSetInitStep(memory_, length);
  ARKStepSetStopTime(memory_, at_most);
  const int status = ARKStepEvolve(memory_, at_most, problem_.state(), &duration_, ARK_ONE_STEP);
  problem_.rethrow();
  ARKStepGetCurrentStep(memory_, &proposed_);
  if (status < 0) problem_.set_failure(OdeProblem::no_step);
  const bool ok = status >= 0 && (duration_ == at_most || problem_.leads_on(duration_));
  problem_.unload(end_, ok);
  return ok;
}

}  // namespace carom::integrators
