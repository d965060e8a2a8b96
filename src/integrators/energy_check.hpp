// The energy as a second estimate of a step's error, where the exact motion keeps it.
//
// An error estimate compares formulas that see the same few points of a step. The energy sees where
// the step has led: a particle that comes out of a step inside a bump, at full speed, has an energy
// it cannot have.
#pragma once

#include <string_view>
#include <vector>

#include "integrators/ode_problem.hpp"

namespace carom::integrators {

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
  /// May the energy change by so much in an accepted step?
  bool allows(const End& from, const End& to, const OdeProblem::Scale& scale, double duration);
  /// The same for a part of a step, which leaves no trace.
  bool allows_part(const End& from, const End& to, const OdeProblem::Scale& scale,
                   double duration) const;
  static constexpr std::string_view failure =
      "the energy changes however short the step: the potential jumps here, or has a pole";

 private:
  double excess(const End& from, const End& to, const OdeProblem::Scale& scale) const;
  double noise(const End& from, const End& to, double size) const;
  double noise_at(const std::vector<Vector>& position, double size) const;

  const ForceLaw<double>& law_;
  double tolerance_;
  double noise_ = 0.0;  ///< of the potential energy, seen in this chain
  bool first_ = true;   ///< no step of the chain has been looked at
};

}  // namespace carom::integrators
