// Adams' method of variable order and step: CVODE of SUNDIALS.
#pragma once

#include <algorithm>
#include <limits>
#include <span>

#include "integrators/energy_check.hpp"
#include "integrators/ode_problem.hpp"

namespace carom::integrators {

/// One call is one internal step of CVODE, or a part of it: between the ends the path is the
/// polynomial of the method, which is continuous. A chain of steps goes on with CVODE's memory; any
/// other start begins anew at order 1, so that this method is for long ways between walls. Parts of
/// steps change nothing. A step that does not keep the energy is undone: the chain begins anew
/// where it began, with a shorter one.
class CvodeStepper final : public Stepper<double> {
 public:
  /// No internal step is longer than `longest`.
  CvodeStepper(const ForceLaw<double>& law, std::span<const double> omega, double tolerance,
               double longest = std::numeric_limits<double>::infinity());
  CvodeStepper(const CvodeStepper&) = delete;
  CvodeStepper& operator=(const CvodeStepper&) = delete;
  ~CvodeStepper() override;

  double step(const Phase<double>& from, double at_most, Phase<double>& to) override;
  std::string_view failure() const override { return problem_.failure(); }

 private:
  void begin(const Phase<double>& from, double longest_first);
  void advance();
  bool take();
  double longest() const { return std::min(longest_, problem_.longest_step()); }

  OdeProblem problem_;
  EnergyCheck energy_;
  double longest_;
  void* memory_ = nullptr;
  void* solver_ = nullptr;
  Phase<double> start_, end_;
  double start_time_ = 0.0, end_time_ = 0.0;  ///< since the chain, or its last renewal, began
  double reached_ = 0.0;                      ///< by the last internal step
  Phase<double> ahead_;                       ///< there
  double reached_energy_ = 0.0;
  double planned_ = 0.0;  ///< length of the next internal step; at most that after a stop
  bool stopped_ = false;  ///< the last one ended where the forces asked it to
  int steps_ = 0;
};

}  // namespace carom::integrators
