// The forces of a system as power series along its orbit, and its potential as a plain formula.
// They share nothing with each other but the system's numbers, so that the energy of an orbit tests
// both.
#pragma once

#include <memory>
#include <vector>

#include "series.hpp"
#include "system.hpp"

namespace resolution {

/// How a summand limits a step that begins at a point: as long as the way is shorter than
/// `distance` it is not felt (below 1e-29 of the kinetic energy at the start); once it may be felt,
/// no step's way is longer than `reach`.
template <class Real>
struct Limit {
  Real distance, reach;
};

template <class Real>
class Force {
 public:
  virtual ~Force() = default;
  virtual Real potential(Real x, Real y) const = 0;
  /// A bound of the potential from below, everywhere; linear parts are bounded by the caller.
  virtual Real lowest() const = 0;
  virtual Limit<Real> limit(Real x, Real y) const = 0;
  /// Called at the start of a step whose way is shorter than `way`.
  virtual void begin(Real, Real, Real) {}
  /// Adds the k-th coefficients of the acceleration, given those of x and y up to k.
  virtual void extend(int k, const Series<Real>& x, const Series<Real>& y, Series<Real>& ax,
                      Series<Real>& ay) = 0;
};

template <class Real>
std::vector<std::unique_ptr<Force<Real>>> forces_of(const System& system);

}  // namespace resolution
