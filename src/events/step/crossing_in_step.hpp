// The first time within a step at which a particle passes from a barrier's positive side to the
// other.
//
// The gap along the path is bounded by its Bernstein coefficients between two knots. Where they
// show that the gap keeps its sign, or only grows, there is no crossing; where it only falls, the
// signs at the ends tell; where it is convex or concave, the knot of its minimum or maximum
// decides. Otherwise the interval is halved by another knot of the path itself. So a path that
// leaves and returns within a step is found, and a path that just fails to touch is distinguished
// from one that touches by the gap at its minimum, computed with the scheme's own partial step.
//
// A particle that is on a wall to rounding and moves outwards hits it at once: several hit
// theirs at the same time, or it is in a corner. One that falls beyond the wall without having
// moved outwards or having come off it, both to rounding, moves along the wall. Parts of a path on
// which the gap changes by no more than its rounding are decided by their ends.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>

#include "events/step/barrier.hpp"
#include "events/step/gap_shape.hpp"
#include "events/step/step_hull.hpp"
#include "events/step/step_path.hpp"

namespace carom::events {

template <class Real>
class CrossingSearch {
 public:
  using Path = StepPath<Real>;
  using Knot = typename Path::Knot;

  explicit CrossingSearch(Path& path) : path_(path) {}

  /// Knot of the first crossing of `barrier` by particle `i` between two knots, or nullptr. There
  /// the particle is on the barrier to rounding.
  Knot* first(const Barrier<Real>& barrier, std::size_t i, Knot& from, Knot& to) {
    begin(true, nullptr);
    if (hits_at_once(barrier, i, from)) return &from;
    return crossing(barrier, i, from, to);
  }
  /// The same for a barrier that is no wall: a particle that starts beyond it has left it. If it is
  /// on it at `from` and goes on (`passes`), it has, too: it crosses again once it was inside by
  /// more than rounding.
  Knot* first_exit(const Barrier<Real>& edge, std::size_t i, Knot& from, Knot& to, bool passes) {
    begin(false, passes ? &from : nullptr);
    return crossing(edge, i, from, to);
  }
  /// About when the path between two knots crosses the barrier; the later one's time if it ends
  /// inside. It says which searches to begin with, and nothing else.
  Real guess(const Barrier<Real>& b, std::size_t i, Knot& from, Knot& to) const {
    if (!(gap(b, i, from) > Real(0))) return from.time;
    if (gap(b, i, to) > Real(0)) return to.time;
    const PathArc<Real> arc(path_, from, to, i);
    // Secants between the ends, the one that stays weighing half (Illinois), until the gap is known
    // to a few digits more than two knots of a path would tell: each gives half as many again.
    Real low(0), high(1), at_low = gap(b, i, from), at_high = gap(b, i, to), part(1);
    for (int n = 0; n < 12; ++n) {
      part = low + (high - low) * (at_low / (at_low - at_high));
      const Real here = b.gap(arc.at(part));
      if (here == Real(0)) break;
      if (here > Real(0)) {
        low = part;
        at_low = here;
        at_high = at_high / Real(2);
      } else {
        high = part;
        at_high = here;
        at_low = at_low / Real(2);
      }
    }
    return from.time + part * (to.time - from.time);
  }
  /// Is what was found last motion along the wall?
  bool slides() const { return slides_; }
  /// Was a search given up, as short parts of the path looked too rough?
  bool gave_up() const { return gave_up_; }

 private:
  // Smooth paths need a few, those that graze some tens. Near a pole of a potential every part
  // would be halved down to rounding. All parts may be halved depth_for_all times.
  static constexpr int depth_for_all = 10;
  static constexpr int most_splits = 2 << depth_for_all;
  // Half a step, halved this often, is less than rounding of its ends.
  static constexpr int deepest = std::numeric_limits<Real>::digits + 10;

  void begin(bool wall, const Knot* passed) {
    splits_ = 0;
    slides_ = false;
    wall_ = wall;
    passed_ = passed;
    last_depth_ = deepest;
  }

  Knot* crossing(const Barrier<Real>& b, std::size_t i, Knot& from, Knot& to) {
    if (&from == &to) return nullptr;
    Knot* found = search(b, i, from, to, 0);
    if (splits_ <= most_splits) return found;
    // If velocity and position disagree slightly, a path almost parallel to the wall stays
    // undecided at any depth. The second search uses the error normal to the wall alone, and stops
    // after ten halvings, where the positions at the ends decide.
    last_depth_ = depth_for_all;
    return search(b, i, from, to, 0);
  }

  Real gap(const Barrier<Real>& b, std::size_t i, const Knot& k) const {
    return b.gap(k.phase.position[i]);
  }
  Real rate(const Barrier<Real>& b, std::size_t i, const Knot& k) const {
    return b.rate(k.phase.position[i], k.phase.velocity[i]);
  }

  // Can the path leave the barrier from here?
  bool inside(const Barrier<Real>& b, std::size_t i, const Knot& k) const {
    if (!passed_) return gap(b, i, k) > Real(0);
    return &k != passed_ && gap(b, i, k) > b.on_wall() * b.rounding(k.phase.position[i]);
  }

  /// Is it certainly on the outer side?
  bool beyond(const Barrier<Real>& b, std::size_t i, const Knot& k) const {
    return gap(b, i, k) < -b.off_wall(k.phase.position[i]);
  }

  bool hits_at_once(const Barrier<Real>& b, std::size_t i, const Knot& k) const {
    const auto &x = k.phase.position[i], &v = k.phase.velocity[i];
    return b.rate(x, v) < -b.rate_rounding(x, v) && b.is_on(x);
  }

  Knot* search(const Barrier<Real>& b, std::size_t i, Knot& from, Knot& to, int depth) {
    const PathArc<Real> arc(path_, from, to, i);
    const Shape shape = GapShape<Real>(b, arc, noise(b, i, from), only_across()).find();
    switch (shape) {
      case Shape::missed:
        return nullptr;
      case Shape::none:
        break;
      case Shape::falling:
      case Shape::level:
        return root(b, i, from, to);
      case Shape::convex: {
        const bool falls = rate(b, i, from)<Real(0), rises = rate(b, i, to)> Real(0);
        if (!falls) break;
        if (!rises) return root(b, i, from, to);
        Knot& lowest = extremum(b, i, from, to);
        return gap(b, i, lowest) > Real(0) ? root(b, i, lowest, to) : root(b, i, from, lowest);
      }
      case Shape::concave: {
        const bool rises = rate(b, i, from) > Real(0), falls = rate(b, i, to) < Real(0);
        if (!falls) break;
        if (!rises || inside(b, i, from)) return root(b, i, from, to);
        Knot& highest = extremum(b, i, from, to);
        return root(b, i, highest, to);
      }
      case Shape::unknown:
        break;
    }
    // A scheme's velocity is not quite the derivative of its positions. Where these lead from the
    // inner side to certainly beyond, there is a crossing, however the velocities at the ends
    // point.
    if (shape != Shape::unknown) {
      if (!wall_ || beyond(b, i, from) || !beyond(b, i, to)) return nullptr;
      if (gap(b, i, from) > Real(0)) return root(b, i, from, to);
    }
    const Real middle = from.time + (to.time - from.time) / Real(2);
    const bool last = depth >= last_depth_;
    if (last || !(from.time < middle) || !(middle < to.time)) {
      Knot* found = root(b, i, from, to);
      if (!found && only_across() && arc.is_rough()) gave_up_ = true;
      return found;
    }
    if (!only_across() && ++splits_ > most_splits) return nullptr;
    Knot& half = path_.at(middle);
    if (Knot* found = search(b, i, from, half, depth + 1)) return found;
    return search(b, i, half, to, depth + 1);
  }

  // Each of two coefficients errs by one rounding of the gap and one of its control point, at most.
  static Real noise(const Barrier<Real>& b, std::size_t i, const Knot& k) {
    return Real(4) * b.rounding(k.phase.position[i]);
  }

  // The gap falls from a point at or beyond the barrier. Where walls meet smoothly that may be the
  // highest point of a path along both, just before this one begins.
  Knot* from_the_wall(const Barrier<Real>& b, std::size_t i, Knot& from, const Knot& to) {
    if (!wall_ || !beyond(b, i, to) || beyond(b, i, from)) return nullptr;
    if (!b.covers(from.phase.position[i])) return at_either_end(b, i, from, from, to);
    slides_ = !hits_at_once(b, i, from);
    return &from;
  }

  // The gap falls from `from` to `to`: its zero, if it has one there and on the piece, to the
  // rounding of the gap. Newton's steps, kept between the best knots on either side.
  Knot* root(const Barrier<Real>& b, std::size_t i, Knot& from, Knot& to) {
    if (gap(b, i, to) > Real(0)) return nullptr;
    if (!inside(b, i, from)) return from_the_wall(b, i, from, to);
    Knot *inside = &from, *outside = &to, *newest = &to;
    // A knot is a step of the whole group, the arc one particle's: to one alone it saves nothing.
    // At the edge of a support no force is left that would bend the path.
    if (wall_ && path_.start().phase.position.size() > 1) {
      const Real about = guess(b, i, from, to);
      if (from.time < about && about < to.time) {
        newest = &path_.at(about);
        (gap(b, i, *newest) > Real(0) ? inside : outside) = newest;
      }
    }
    for (int n = 0; n < 2 * deepest; ++n) {
      const Real g = gap(b, i, *newest);
      const Real size = g < Real(0) ? -g : g;
      if (!(size > b.rounding(newest->phase.position[i]))) {
        inside = newest;
        break;
      }
      const Real middle = inside->time + (outside->time - inside->time) / Real(2);
      const Real slope = rate(b, i, *newest);
      Real next = slope < Real(0) ? newest->time - g / slope : middle;
      if (n % 8 == 7 || !(inside->time < next) || !(next < outside->time)) next = middle;
      if (!(inside->time < next) || !(next < outside->time)) break;
      newest = &path_.at(next);
      (gap(b, i, *newest) > Real(0) ? inside : outside) = newest;
    }
    if (b.covers(inside->phase.position[i])) return inside;
    return at_either_end(b, i, *inside, from, to);
  }

  Knot* at_either_end(const Barrier<Real>& b, std::size_t i, Knot& found, const Knot& from,
                      const Knot& to) {
    if (b.closed) return nullptr;
    Knot* joint = at_end(b, Barrier<Real>::End::from, i, found, from, to);
    return joint ? joint : at_end(b, Barrier<Real>::End::to, i, found, from, to);
  }

  // The path crosses the carrier beyond the piece. If it also passes that end of the piece, to
  // rounding, the gap changes by no more than rounding between the two, and they cannot be
  // distinguished apart: nearly along a wall, that may be many roundings of the point. The wall
  // beyond the joint may find its crossing before it, so neither would be hit. Points of the path
  // are rounded as its start is, be they nearer to the origin.
  Knot* at_end(const Barrier<Real>& b, typename Barrier<Real>::End which, std::size_t i,
               Knot& found, const Knot& from, const Knot& to) {
    const auto &x = found.phase.position[i], &start = path_.start().phase.position[i],
               &end = b.point(which);
    const Real near =
        b.reach_of_joint(which, b.reach_of_wall(b.rounding(x) < b.rounding(start) ? start : x));
    Knot* there = &found;
    for (int n = 0; n < 3; ++n) {  // the path is nearly straight, so nearly at once
      const auto &y = there->phase.position[i], &v = there->phase.velocity[i];
      const Real time = there->time + dot(end - y, v) / dot(v, v);
      if (!(from.time <= time) || !(time <= to.time)) return nullptr;
      there = &path_.at(time);
      if (!(PathHull<Real>::norm(there->phase.position[i] - end) > near)) return there;
    }
    return nullptr;
  }

  // Finds where the gap's rate changes sign: regula falsi with halved weights (Illinois).
  Knot& extremum(const Barrier<Real>& b, std::size_t i, Knot& from, Knot& to) {
    Knot *low = &from, *high = &to;
    Real at_low = rate(b, i, from), at_high = rate(b, i, to);
    const bool convex = at_low < Real(0);
    for (int n = 0; n < 4 * deepest; ++n) {
      const Real width = high->time - low->time;
      Real next = low->time + width * (at_low / (at_low - at_high));
      if (n % 4 == 3 || !(low->time < next) || !(next < high->time))
        next = low->time + width / Real(2);
      if (!(low->time < next) || !(next < high->time)) break;
      Knot& middle = path_.at(next);
      const Real r = rate(b, i, middle);
      if (r == Real(0)) return middle;
      // A minimum already beyond the barrier, or a maximum before it, says all that is asked.
      if (convex ? !(gap(b, i, middle) > Real(0)) : inside(b, i, middle)) return middle;
      if ((r < Real(0)) == convex) {
        low = &middle;
        at_low = r;
        at_high = at_high / Real(2);
      } else {
        high = &middle;
        at_high = r;
        at_low = at_low / Real(2);
      }
    }
    return (gap(b, i, *low) > gap(b, i, *high)) == convex ? *high : *low;
  }

  /// Is this the search after one that ran out of splits?
  bool only_across() const { return last_depth_ < deepest; }

  Path& path_;
  int splits_ = 0;  ///< of the search under way
  int last_depth_ = deepest;
  bool gave_up_ = false;
  bool wall_ = true;  ///< the barrier under way is one
  bool slides_ = false;
  const Knot* passed_ = nullptr;  ///< where the particle has just crossed the barrier and went on
};

}  // namespace carom::events
