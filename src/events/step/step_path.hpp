// The path of a group within one step of its scheme, and its dense output.
//
// A point of the path at time t after the start is the scheme's own step of length t from the
// start. Between two such knots the path is seen as the quintic that has their positions,
// velocities and accelerations; by how much a cubic without the accelerations differs from it
// bounds what it errs, as the quintic's own error is of a higher order.
//
// Of several particles a step costs a sum over all pairs for each of its stages. So a knot that is
// very near another one is reached from there by a step of second order, if what that one errs by
// is below the rounding of the scheme's own.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "carom/integrators/stepper.hpp"
#include "events/step/step_hull.hpp"

namespace carom::events {

template <class Real>
class StepPath {
 public:
  using Vector = geometry::BasicVector<Real>;
  struct Knot {
    Real time{};
    Phase<Real> phase;
    std::vector<Vector> acceleration;  ///< with the magnetic part; empty until asked for
  };

  /// Refers to all three; `omega` has one entry a particle.
  StepPath(Stepper<Real>& stepper, const ForceLaw<Real>& law, std::span<const Real> omega)
      : stepper_(stepper), law_(law), omega_(omega) {}

  /// A new path from `from`, whose first step takes at most `at_most`. Returns the time it takes.
  Real begin(const Phase<Real>& from, Real at_most) {
    // A path that goes on where the last one ended keeps what is known there.
    const bool goes_on =
        used_ > 1 && end().phase.position == from.position && end().phase.velocity == from.velocity;
    if (goes_on) {
      std::swap(knots_[0], knots_[1]);
      used_ = 1;
    } else {
      used_ = 0;
      fresh().phase = from;
    }
    start().time = Real(0);
    Knot& end = fresh();
    end.time = stepper_.step(from, at_most, end.phase);
    return end.time;
  }
  /// The next path is a new one, wherever it begins.
  void forget() { used_ = 0; }
  Knot& start() { return *knots_[0]; }
  Knot& end() { return *knots_[1]; }

  /// The knot at a time between start and end. It stays valid until the next begin.
  Knot& at(Real time) {
    for (std::size_t i = 0; i < used_; ++i)
      if (knots_[i]->time == time) return *knots_[i];
    Knot* const near = nearest(time);
    Knot& knot = fresh();
    knot.time = time;
    if (!near || !reach(*near, knot)) move(time, knot.phase);
    return knot;
  }
  /// Keeps the start, the end and this knot alone where all of them together are large.
  void keep_few(Knot& one) {
    constexpr std::size_t most = std::size_t{1}
                                 << 20;  // particles at all knots: some tens of megabytes
    if (used_ < 4 || used_ * start().phase.position.size() < most) return;
    const auto there = std::find_if(knots_.begin(), knots_.end(),
                                    [&](const auto& knot) { return knot.get() == &one; });
    if (there - knots_.begin() > 2) std::swap(knots_[2], *there);
    used_ = 3;
  }
  /// The phase at a time, without keeping it.
  void move(Real time, Phase<Real>& to) {
    if (!(time > Real(0)) || time == end().time) {
      to = (time > Real(0) ? end() : start()).phase;
      return;
    }
    Real done = stepper_.step(start().phase, time, to);
    while (done < time) {  // an adaptive scheme may take several steps
      const Phase<Real> from = to;
      done = done + stepper_.step(from, time - done, to);
    }
  }

  /// Acceleration of particle i at a knot, with the magnetic part.
  const Vector& acceleration(Knot& knot, std::size_t i) const {
    if (knot.acceleration.empty()) {
      evaluate(knot);
      for (std::size_t k = 0; k < omega_.size(); ++k)
        knot.acceleration[k] = knot.acceleration[k] + omega_[k] * right(knot.phase.velocity[k]);
    }
    return knot.acceleration[i];
  }

 private:
  bool several() const { return knots_.front()->phase.position.size() > 1; }

  void evaluate(Knot& knot) const {
    const std::vector<Vector>& x = knot.phase.position;
    const std::span<const Vector> known =
        several() ? stepper_.remembered(x) : std::span<const Vector>{};
    if (!known.empty()) return knot.acceleration.assign(known.begin(), known.end());
    knot.acceleration.resize(x.size());
    law_.accelerations(x, knot.acceleration);
  }

  /// Of several particles: the knot that is nearest to a time and is no start.
  Knot* nearest(const Real& time) const {
    Knot* best = nullptr;
    const auto apart = [&](const Knot& k) { return k.time < time ? time - k.time : k.time - time; };
    if (several())
      for (std::size_t i = 1; i < used_; ++i)
        if (!best || apart(*knots_[i]) < apart(*best)) best = knots_[i].get();
    return best;
  }

  /// Goes from one knot to one a time d later, or earlier: x += d v + d^2 a/2 + d^3 j/6, and v by
  /// the trapezoid of accelerations, j being the mean rate of change of a since the start. A
  /// velocity has been rounded at each kick of the step that led to the knot, in all by more than
  /// eps/2 (|v| + t |a|). To know the acceleration at the new place only by a and j, which saves
  /// its evaluation, errs by less than d^2 J/2, J being the sum of both accelerations over t, which
  /// does not vanish where their difference happens to. Otherwise the new acceleration differs from
  /// a + d j by s d (d + t)/2 if its second derivative is s, and the trapezoid errs by s d^3/12.
  /// False where that is not below the rounding.
  bool reach(Knot& from, Knot& to) const {
    const Real t = from.time, d = to.time - t;
    if (!((d < Real(0) ? -d : d) * Real(64) < t)) return false;  // far too large
    acceleration(*knots_.front(), 0);
    acceleration(from, 0);
    const std::size_t n = from.phase.position.size();
    const std::vector<Vector>&before = knots_.front()->acceleration, &a = from.acceleration;
    const Real epsilon = std::numeric_limits<Real>::epsilon();
    std::vector<Vector> expected(n);
    const auto is_below_rounding = [&](std::size_t i, const Real& error) {
      const auto norm = [](const Vector& e) { return step_hull::norm(e); };
      return !(Real(2) * error > epsilon * (norm(from.phase.velocity[i]) + t * norm(a[i])));
    };
    bool known = true;
    to.phase.position.resize(n);
    to.phase.velocity.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      const Vector &v = from.phase.velocity[i], change = (d / t) * (a[i] - before[i]);
      known = known && is_below_rounding(
                           i, d * d / t * (step_hull::norm(a[i]) + step_hull::norm(before[i])));
      expected[i] = a[i] + change;
      to.phase.position[i] =
          from.phase.position[i] +
          d * (v + d * ((Real(1) / Real(2)) * a[i] + (Real(1) / Real(6)) * change));
      to.phase.velocity[i] = v + (d / Real(2)) * (a[i] + expected[i]);
    }
    if (known) {
      to.acceleration = std::move(expected);
      return true;
    }
    acceleration(to, 0);
    for (std::size_t i = 0; i < n; ++i) {
      const Vector missed = to.acceleration[i] - expected[i];
      const Real error = d * d / (Real(6) * (d + t)) * step_hull::norm(missed);
      if (!is_below_rounding(i, error)) {
        to.acceleration.clear();
        return false;
      }
      to.phase.velocity[i] = from.phase.velocity[i] + (d / Real(2)) * (a[i] + to.acceleration[i]);
    }
    return true;
  }

  Knot& fresh() {
    if (used_ == knots_.size()) knots_.push_back(std::make_unique<Knot>());
    knots_[used_]->acceleration.clear();
    return *knots_[used_++];
  }

  Stepper<Real>& stepper_;
  const ForceLaw<Real>& law_;
  std::span<const Real> omega_;
  std::vector<std::unique_ptr<Knot>> knots_;
  std::size_t used_ = 0;
};

/// What contains one particle's path between two knots.
template <class Real>
struct PathHull : StepHull<Real> {
  using Vector = geometry::BasicVector<Real>;

  PathHull(const typename StepPath<Real>::Knot& a, const typename StepPath<Real>::Knot& b,
           std::size_t i)
      : StepHull<Real>(a.phase.position[i], a.phase.velocity[i], b.phase.position[i],
                       b.phase.velocity[i], (b.time - a.time) / Real(3)) {}
  static Real norm(const Vector& a) { return step_hull::norm(a); }
};

/// One particle's path between two knots as a Bezier curve of degree 5, and how far its control
/// points are from those of the cubic without the accelerations, raised to that degree.
template <class Real>
struct PathArc {
  using Vector = geometry::BasicVector<Real>;
  std::array<Vector, 6> points;
  std::array<Vector, 2> difference;  ///< of points 2 and 3; the others agree
  Real error{};                      ///< the larger of them, in the 1-norm

  PathArc(const StepPath<Real>& path, typename StepPath<Real>::Knot& a,
          typename StepPath<Real>::Knot& b, std::size_t i) {
    const Real h = b.time - a.time;
    const Vector &x0 = a.phase.position[i], &x1 = b.phase.position[i];
    const Vector v0 = h * a.phase.velocity[i], v1 = h * b.phase.velocity[i];
    const Vector a0 = (h * h) * path.acceleration(a, i), a1 = (h * h) * path.acceleration(b, i);
    const Real fifth = Real(1) / Real(5), twentieth = Real(1) / Real(20);
    points = {x0,
              x0 + fifth * v0,
              x0 + (Real(2) * fifth) * v0 + twentieth * a0,
              x1 - (Real(2) * fifth) * v1 + twentieth * a1,
              x1 - fifth * v1,
              x1};
    const Real tenth = Real(1) / Real(10), third = Real(1) / Real(3);
    const Vector c1 = x0 + third * v0, c2 = x1 - third * v1;
    difference = {points[2] - tenth * (x0 + Real(6) * c1 + Real(3) * c2),
                  points[3] - tenth * (x1 + Real(6) * c2 + Real(3) * c1)};
    error = std::max(PathHull<Real>::norm(difference[0]), PathHull<Real>::norm(difference[1]));
  }
  /// The point at a part of the way, 0 to 1 (de Casteljau).
  Vector at(const Real& part) const {
    std::array<Vector, 6> p = points;
    for (std::size_t last = 5; last > 0; --last)
      for (std::size_t k = 0; k < last; ++k) p[k] = p[k] + part * (p[k + 1] - p[k]);
    return p[0];
  }
  /// The larger of them along a unit vector.
  Real error_along(const Vector& unit) const {
    const Real low = dot(unit, difference[0]), high = dot(unit, difference[1]);
    return std::max(std::max(low, -low), std::max(high, -high));
  }
  /// Does the path's derivative err by more than the way, straight or as the velocities at its ends
  /// lead? Control points that err by `error` make that of degree 5 err by ten times as much.
  bool is_rough() const {
    const auto norm = &PathHull<Real>::norm;
    const Real led = Real(5) * std::max(norm(points[1] - points[0]), norm(points[5] - points[4]));
    return Real(10) * error > std::max(led, norm(points[5] - points[0]));
  }
};

}  // namespace carom::events
