// Explicit Runge–Kutta with control of the error: ARKODE of SUNDIALS.
#pragma once

#include <cstdio>  // for the headers of ARKODE, which use FILE

#include <arkode/arkode_butcher.h>

#include <span>

#include "integrators/energy_check.hpp"
#include "integrators/ode_problem.hpp"

namespace carom::integrators {

/// One call is one step of the method. A shorter one
/// from the same start is the same method's step of that length, so that a path may be cut
/// anywhere. A chain of steps, each from where the last one ended, takes over the length that the
/// error control proposes; any other start begins with a guess. So the path is a function of where
/// its chain began, and parts of steps in between change nothing. A step is shortened until it
/// resolves the forces and keeps the energy.
class ArkodeStepper final : public Stepper<double> {
 public:
  /// Without a table: verner_9_8().
  ArkodeStepper(const ForceLaw<double>& law, std::span<const double> omega, double tolerance,
                ARKodeButcherTable table = nullptr);
  ArkodeStepper(const ArkodeStepper&) = delete;
  ArkodeStepper& operator=(const ArkodeStepper&) = delete;
  ~ArkodeStepper() override;

  double step(const Phase<double>& from, double at_most, Phase<double>& to) override;
  std::string_view failure() const override { return problem_.failure(); }

 private:
  void part(double duration, Phase<double>& to);
  void whole(double at_most);
  bool take(double length, double at_most);

  OdeProblem problem_;
  EnergyCheck energy_;
  int order_;
  void* memory_ = nullptr;
  Phase<double> start_, end_;
  double start_energy_ = 0.0, end_energy_ = 0.0;
  OdeProblem::Scale scale_;  ///< at the start
  double guess_ = 0.0;       ///< length to try from the start
  double asked_ = 0.0;       ///< at most, for the step from start to end
  double duration_ = 0.0;    ///< from start to end
  double proposed_ = 0.0;    ///< length to try from the end
};

}  // namespace carom::integrators
