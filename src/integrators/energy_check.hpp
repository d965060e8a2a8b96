// The energy as a second estimate of a step's error, where the exact motion keeps it.
//
// An error estimate compares formulas that see the same few points of a step. The energy sees where the step has led:
// a particle that comes out of a step inside a bump, at full speed, has an energy it cannot have.
#pragma once

#include <span>
#include <vector>

#include "integrators/ode_problem.hpp"

namespace carom {

class EnergyCheck {
 public:
  using Vector = geometry::Vector;

  EnergyCheck(const ForceLaw<double>& law, double tolerance) : law_(law), tolerance_(tolerance) {}

  /// Kinetic and potential energy; 0 if the law keeps none.
  double at(const Phase<double>&) const;
  /// A chain of steps begins.
  void begin();

  struct End {
    const Phase<double>& phase;
    double energy;
  };
  /// May the energy change by so much in an accepted step? `acceleration`: by the forces, at its end.
  bool allows(const End& from, const End& to, std::span<const Vector> acceleration, const OdeProblem::Scale& scale,
              double duration);
  static constexpr std::string_view failure =
      "the energy changes however short the step: the potential jumps here, or has a pole";

 private:
  double noise(const Phase<double>& at, double size);

  const ForceLaw<double>& law_;
  double tolerance_;
  double noise_ = 0.0;  ///< of the potential energy, seen in this chain
  bool first_ = true;   ///< no step of the chain has been looked at
  std::vector<Vector> moved_;
};

}  // namespace carom
