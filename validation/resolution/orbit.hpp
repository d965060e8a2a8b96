// The reference: Taylor's method with walls. A step is as long as the series' last terms allow, and
// never longer than what the forces' own lengths allow, so that it cannot pass over one that its
// start does not show.
#pragma once

#include <memory>
#include <stdexcept>
#include <vector>

#include "forces.hpp"

namespace resolution {

template <class Real>
struct State {
  Real x, y, vx, vy;
};

struct Accuracy {
  int order;         ///< of the series
  double tolerance;  ///< of their last terms
  double way = 1.0;  ///< factor of the longest way that forces allow
};

constexpr Accuracy quad_accuracy = {36, 1e-31}, finer_accuracy = {45, 1e-33, 0.5},
                   quick_accuracy = {24, 1e-20};

/// An orbit that touches a wall without crossing it, or goes into a corner: no reference is given.
struct Undecided : std::runtime_error {
  using std::runtime_error::runtime_error;
};

template <class Real>
class Orbit {
 public:
  Orbit(const System& system, Accuracy accuracy);

  /// Goes on until `end`, a time after the present one.
  void advance(Real end);
  Real energy() const;
  void turn_back();  ///< reverses velocity and field

  State<Real> state;
  Real time = 0;
  Real fastest = 0;  ///< largest speed at the ends of steps
  long steps = 0, hits = 0;

 private:
  void expand(Real way);
  Real longest_way() const;
  Real time_for(Real way, Real energy) const;
  Real step_by_series() const;
  bool find_hit(Real step, Real& when, int& wall) const;

  const System& system_;
  Accuracy accuracy_;
  std::vector<std::unique_ptr<Force<Real>>> forces_;
  std::vector<char> felt_;
  Real field_, pull_x_ = 0, pull_y_ = 0, lowest_ = 0;
  int on_wall_ = -1;
  Series<Real> x_, y_, vx_, vy_;
};

extern template class Orbit<Quad>;
extern template class Orbit<long double>;

}  // namespace resolution
