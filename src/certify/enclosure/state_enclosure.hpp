// A set of states: numbers of many bits, and bounds of their errors.
#pragma once

#include <memory>

#include "certify/flight/scene.hpp"

namespace carom::certify {

/// A state in balls that contain the true one.
struct BallState {
  BallVector position, velocity;
  Ball time;
};

/// Where an orbit runs, in balls and in intervals, with the units of its errors.
struct Arena {
  SceneOf<Ball> scene;
  SceneOf<Interval> fast;
  double unit = 1.0, time_unit = 1.0;
  double speed = 1.0;  ///< at least the speed, and that of midpoints

  const WallOf<Ball>& wall(int index) const { return scene.walls[static_cast<std::size_t>(index)]; }
  const WallOf<Interval>& fast_wall(int index) const {
    return fast.walls[static_cast<std::size_t>(index)];
  }
};

/// The state of an orbit on its way from wall to wall. Positions are in the cell of the last hit.
class StateEnclosure {
 public:
  virtual ~StateEnclosure() = default;
  virtual std::unique_ptr<StateEnclosure> clone() const = 0;

  /// Flies to the wall that is next and is reflected there. `same`: the state lies on that wall, in
  /// that cell.
  virtual void fly(const Copy&, bool same, long bits) = 0;

  /// Contains the true state; by numbers of that many bits where it has more than it needs.
  virtual BallState state(long bits) const = 0;
  virtual VectorOf<Interval> position() const = 0;
  virtual VectorOf<Interval> velocity() const = 0;
  virtual Ball time() const = 0;
  virtual Bound position_error() const = 0;
  virtual Bound velocity_error() const = 0;
  virtual Bound time_error() const = 0;
  /// How much the errors have grown, in units of the arena: what neighbouring orbits part by.
  virtual Bound error() const = 0;
  /// Bits that the next flight needs, for its rounding to be of no weight.
  virtual double useful_bits() const = 0;
};

/// To the present precision.
inline BallVector rounded(const BallVector& v) { return {v.x.rounded(), v.y.rounded()}; }
inline BallVector middle(const BallVector& v) { return {v.x.midpoint(), v.y.midpoint()}; }
inline Bound radius(const BallVector& v) { return v.x.radius() + v.y.radius(); }
inline geometry::Vector near(const BallVector& v) { return {v.x.to_double(), v.y.to_double()}; }
inline VectorOf<Interval> interval_of(const BallVector& v, const Bound& error = {}) {
  return {interval_of(v.x, error), interval_of(v.y, error)};
}
inline Bound size_of(const Interval& x) {
  const double size = x.size();
  return std::isfinite(size) ? Bound(size) : Bound(HUGE_VAL);
}
inline Interval length(const VectorOf<Interval>& v) { return sqrt(square(v.x) + square(v.y)); }
/// 1/x of a number that is not zero, rounded up.
inline Bound inverse_of(const Interval& x) { return size_of(Interval(1.0) / x); }
/// A correction by this ball, of which only the first bits count: short factors make products
/// cheap.
inline Ball first_bits(const Ball& x) {
  const Precision few(64);
  return x.rounded().midpoint();
}

}  // namespace carom::certify
