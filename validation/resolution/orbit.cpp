#include "orbit.hpp"

#include <algorithm>

namespace resolution {
namespace {

template <class Real>
Real value(const Series<Real>& p, int order, Real t) {
  Real sum = p[order];
  for (int k = order; k-- > 0;) sum = sum * t + p[k];
  return sum;
}

template <class Real>
Real slope(const Series<Real>& p, int order, Real t) {
  Real sum = Real(order) * p[order];
  for (int k = order; k-- > 1;) sum = sum * t + Real(k) * p[k];
  return sum;
}

/// The first root in (0, end] of a polynomial that is positive at 0. Intervals are excluded, or
/// known to hold one root at most, by bounds of the derivatives over all of [0, end].
template <class Real>
class FirstRoot {
 public:
  FirstRoot(const Series<Real>& p, int order, Real end) : p_(p), order_(order), end_(end) {
    Real power = 1;
    for (int k = 1; k <= order; ++k) {
      const Real c = Real(k) * size(p[k]);
      first_ += c * power;
      if (k > 1) second_ += Real(k - 1) * c * (power / end);
      power *= end;
    }
  }

  bool find(Real& root_found) {
    found_ = end_;
    if (!search(Real(0), end_, 0)) return false;
    root_found = found_;
    return true;
  }

 private:
  Real at(Real t) const { return value(p_, order_, t); }

  bool search(Real a, Real b, int depth) {
    const Real middle = (a + b) / 2, half = (b - a) / 2;
    if (at(middle) > first_ * half) return false;
    if (size(slope(p_, order_, middle)) > second_ * half) {
      if (at(b) > 0) return false;
      refine(a, b);
      return true;
    }
    if (depth > 90) throw Undecided("a wall is touched");
    return search(a, middle, depth + 1) || search(middle, b, depth + 1);
  }

  // p(a) > 0 >= p(b), monotonic between: Newton's method, kept between them.
  void refine(Real a, Real b) {
    Real t = (a + b) / 2;
    for (int round = 0; round < 300; ++round) {
      const Real f = at(t);
      (f > 0 ? a : b) = t;
      Real next = t - f / slope(p_, order_, t);
      if (!(next > a && next < b)) next = (a + b) / 2;
      if (next == t || next == a || next == b) break;
      t = next;
    }
    found_ = t;
  }

  const Series<Real>& p_;
  int order_;
  Real end_, found_ = 0, first_ = 0, second_ = 0;
};

}  // namespace

template <class Real>
Orbit<Real>::Orbit(const System& system, Accuracy accuracy)
    : state{system.start[0], system.start[1], system.start[2], system.start[3]},
      system_(system),
      accuracy_(accuracy),
      forces_(forces_of<Real>(system)),
      felt_(forces_.size(), 0),
      field_(system.field) {
  for (const Term& term : system.terms) {
    if (term.shape != Term::Shape::linear) continue;
    pull_x_ += Real(term.a);
    pull_y_ += Real(term.b);
  }
  for (const auto& force : forces_) lowest_ += force->lowest();
}

template <class Real>
Real Orbit<Real>::energy() const {
  Real sum = (state.vx * state.vx + state.vy * state.vy) / 2;
  for (const auto& force : forces_) sum += force->potential(state.x, state.y);
  return sum;
}

template <class Real>
void Orbit<Real>::turn_back() {
  state.vx = -state.vx;
  state.vy = -state.vy;
  field_ = -field_;
  on_wall_ = -1;  // reversed within a flight
  time = 0;
}

template <class Real>
Real Orbit<Real>::longest_way() const {
  Real way = 1e30L;
  for (const auto& force : forces_) {
    const Limit<Real> limit = force->limit(state.x, state.y);
    way = std::min(way, std::max(limit.distance, Real(accuracy_.way) * limit.reach));
  }
  return way;
}

// A time in which no way longer than `way` can be gone: with the energy E - (lowest potential) all
// kinetic, and the uniform force F adding to it, the way is at most v t + F t²/2; each of the two
// gets half.
template <class Real>
Real Orbit<Real>::time_for(Real way, Real energy) const {
  const Real pull = root(pull_x_ * pull_x_ + pull_y_ * pull_y_);
  const Real kinetic = energy + pull_x_ * state.x + pull_y_ * state.y - lowest_;
  const Real speed = root(std::max(Real(2) * kinetic, state.vx * state.vx + state.vy * state.vy));
  Real time_left = way / (Real(2) * speed + Real(1e-30L));
  if (pull > 0) time_left = std::min(time_left, root(way / pull));
  return time_left;
}

template <class Real>
void Orbit<Real>::expand(Real way) {
  for (std::size_t i = 0; i < forces_.size(); ++i) {
    felt_[i] = forces_[i]->limit(state.x, state.y).distance < way;
    if (felt_[i]) forces_[i]->begin(state.x, state.y, way);
  }
  x_[0] = state.x;
  y_[0] = state.y;
  vx_[0] = state.vx;
  vy_[0] = state.vy;
  Series<Real> ax, ay;
  for (int order = 0; order < accuracy_.order; ++order) {
    const auto k = static_cast<std::size_t>(order);
    ax[k] = field_ * vy_[k];
    ay[k] = -field_ * vx_[k];
    for (std::size_t i = 0; i < forces_.size(); ++i)
      if (felt_[i]) forces_[i]->extend(order, x_, y_, ax, ay);
    const Real next = Real(1) / Real(order + 1);
    x_[k + 1] = vx_[k] * next;
    y_[k + 1] = vy_[k] * next;
    vx_[k + 1] = ax[k] * next;
    vy_[k + 1] = ay[k] * next;
  }
}

// The step at which the last two terms of position and velocity are `tolerance`, shortened by a
// safety factor.
template <class Real>
Real Orbit<Real>::step_by_series() const {
  Real shortest = 1e30L;
  for (int order = accuracy_.order - 1; order <= accuracy_.order; ++order) {
    const auto k = static_cast<std::size_t>(order);
    const Real largest =
        std::max(std::max(size(x_[k]), size(y_[k])), std::max(size(vx_[k]), size(vy_[k])));
    if (largest > 0)
      shortest = std::min(
          shortest, exponential(logarithm(Real(accuracy_.tolerance) / largest) / Real(order)));
  }
  return Real(0.7L) * shortest;
}

template <class Real>
bool Orbit<Real>::find_hit(Real step, Real& when, int& wall) const {
  const Real limits[4] = {0, system_.width, 0, system_.height};
  bool any = false;
  Real first = step;
  for (int side = 0; side < 4; ++side) {
    const Series<Real>& path = side < 2 ? x_ : y_;
    // Distance from the wall, positive inside. From the wall that it stands on, a root at 0 is
    // divided out.
    Series<Real> gap{};
    const Real sign = side % 2 == 0 ? 1 : -1;
    const int shift = side == on_wall_ ? 1 : 0, order = accuracy_.order - shift;
    for (int k = 0; k <= order; ++k) gap[k] = sign * path[k + shift];
    if (shift == 0) gap[0] = sign * (path[0] - limits[side]);
    if (!(gap[0] > 0)) throw Undecided("no clear start at a wall");
    Real found;
    if (!FirstRoot<Real>(gap, order, first).find(found)) continue;
    if (any && first - found < Real(1e-20L)) throw Undecided("a corner is met");
    any = true;
    first = found;
    wall = side;
  }
  when = first;
  return any;
}

template <class Real>
void Orbit<Real>::advance(Real end) {
  while (time < end) {
    const Real way = longest_way();
    expand(way);
    Real step = std::min(std::min(step_by_series(), time_for(way, energy())), end - time);
    const bool last = !(step < end - time);
    if (!(step > 0)) throw Undecided("no step is short enough");
    Real when = step;
    int wall = -1;
    const bool hit = system_.box && find_hit(step, when, wall);
    state = {value(x_, accuracy_.order, when), value(y_, accuracy_.order, when),
             value(vx_, accuracy_.order, when), value(vy_, accuracy_.order, when)};
    on_wall_ = -1;
    if (hit) {
      if (wall < 2) {
        state.x = wall == 0 ? Real(0) : Real(system_.width);
        state.vx = -state.vx;
      } else {
        state.y = wall == 2 ? Real(0) : Real(system_.height);
        state.vy = -state.vy;
      }
      on_wall_ = wall;
      ++hits;
      time += when;
    } else {
      time = last ? end : time + when;
    }
    fastest = std::max(fastest, root(state.vx * state.vx + state.vy * state.vy));
    ++steps;
  }
}

template class Orbit<Quad>;
template class Orbit<long double>;

}  // namespace resolution
