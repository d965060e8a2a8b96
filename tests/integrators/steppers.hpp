// A scheme's stepper in any arithmetic, and a walk with equal steps.
#pragma once

#include <memory>
#include <span>

#include "carom/integrators/scheme.hpp"
#include "integrators/splitting.hpp"
#include "integrators/spreiter_walter.hpp"

namespace carom {

template <class Real>
std::unique_ptr<Stepper<Real>> stepper_of(const Scheme& scheme, const ForceLaw<Real>& law,
                                          std::span<const Real> omega) {
  if (scheme.form == Scheme::Form::spreiter_walter) {
    return std::make_unique<integrators::SpreiterWalterStepper<Real>>(law, omega);
  }
  return std::make_unique<integrators::SplittingStepper<Real>>(scheme, law, omega);
}

template <class Real>
Phase<Real> walk(Stepper<Real>& stepper, Phase<Real> phase, const Real& step, int steps) {
  Phase<Real> next;
  for (int k = 0; k < steps; ++k) {
    stepper.step(phase, step, next);
    std::swap(phase, next);
  }
  return phase;
}

/// Largest difference of a coordinate or velocity.
template <class Real>
Real distance(const Phase<Real>& a, const Phase<Real>& b) {
  Real largest(0);
  const auto take = [&](const Real& d) {
    const Real size = d < Real(0) ? Real(-d) : d;
    if (!(size < largest)) largest = size;
  };
  for (std::size_t i = 0; i < a.position.size(); ++i) {
    take(a.position[i].x - b.position[i].x);
    take(a.position[i].y - b.position[i].y);
    take(a.velocity[i].x - b.velocity[i].x);
    take(a.velocity[i].y - b.velocity[i].y);
  }
  return largest;
}

}  // namespace carom
