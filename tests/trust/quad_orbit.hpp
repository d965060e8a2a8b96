// The true orbit among segments and circular arcs, in 113 bits: a slow, obvious witness.
#pragma once

#include <vector>

#include "geometry/quad.hpp"
#include "tables_by_hand.hpp"

namespace carom::tests {

struct QuadHit {
  int wall = -1;
  QuadVector position, velocity;  ///< after the reflection
  Quad time = 0;
};

/// From an exact point with an exact velocity; wall by wall, hit by hit.
class QuadOrbit {
 public:
  QuadOrbit(const Table& table, QuadVector position, QuadVector velocity, double omega)
      : omega_(Quad(omega)) {
    for (const Wall& wall : table.walls) {
      const QuadCurve curve(wall.curve);
      walls_.push_back({curve, dot(curve.a, curve.a), geometry::is_closed(wall.curve)});
    }
    now_.position = position;
    now_.velocity = velocity;
  }

  const QuadHit& next() {
    QuadHit first;
    Quad soonest = -1;
    for (std::size_t i = 0; i < walls_.size(); ++i)
      for (const Quad& t : meetings(walls_[i])) {
        if (!(t > Quad(1e-20)) || (soonest > 0 && !(t < soonest))) continue;
        const auto [x, v] = at(t);
        const QuadVector n = normal(walls_[i], x);
        if (!(dot(n, v) < 0) || !on_piece(walls_[i], x)) continue;
        soonest = t;
        first.wall = static_cast<int>(i);
        first.position = x;
        first.velocity = v - (2 * dot(n, v) / dot(n, n)) * n;
        first.time = now_.time + t;
      }
    return now_ = first;
  }

 private:
  struct QuadWall {
    QuadCurve curve;
    Quad r2;
    bool closed;
  };

  std::pair<QuadVector, QuadVector> at(const Quad& t) const {
    const QuadVector v = now_.velocity, j = right(v);
    if (omega_ == 0) return {now_.position + t * v, v};
    const Quad s = sine(omega_ * t), half = sine(omega_ * t / 2), c = cosine(omega_ * t);
    return {now_.position + (s / omega_) * v + (2 * half * half / omega_) * j, c * v + s * j};
  }
  static QuadVector normal(const QuadWall& w, const QuadVector& x) {
    if (w.curve.segment) return left(w.curve.to - w.curve.from);
    return w.curve.sense * (w.curve.centre - x);
  }
  static bool on_piece(const QuadWall& w, const QuadVector& x) {
    if (w.closed) return true;
    const QuadVector chord = w.curve.to - w.curve.from;
    if (w.curve.segment) {
      const Quad along = dot(x - w.curve.from, chord);
      return along >= 0 && along < dot(chord, chord);
    }
    return w.curve.sense * cross(chord, x - w.curve.from) < 0;
  }
  /// Times at which the flight meets the whole line or circle.
  std::vector<Quad> meetings(const QuadWall& w) const {
    if (omega_ != 0) return larmor_meetings(w);
    const QuadVector v = now_.velocity;
    if (w.curve.segment) {
      const QuadVector n = normal(w, now_.position);
      if (dot(n, v) == 0) return {};
      return {dot(n, w.curve.from - now_.position) / dot(n, v)};
    }
    const QuadVector e = now_.position - w.curve.centre;
    const Quad a = dot(v, v), b = dot(e, v), c = dot(e, e) - w.r2, d = b * b - a * c;
    if (d < 0) return {};
    const Quad q = root(d);
    return {(-b - q) / a, (-b + q) / a};
  }
  std::vector<Quad> larmor_meetings(const QuadWall& w) const {
    const QuadVector v = now_.velocity;
    const QuadVector centre = now_.position + (1 / omega_) * right(v);
    const Quad rho2 = dot(v, v) / (omega_ * omega_);
    QuadVector foot, along;  // the common chord: foot +- half * along
    Quad half2 = 0;
    if (w.curve.segment) {
      const QuadVector d = w.curve.to - w.curve.from;
      along = (1 / root(dot(d, d))) * d;
      foot = w.curve.from + dot(centre - w.curve.from, along) * along;
      half2 = rho2 - dot(foot - centre, foot - centre);
    } else {
      const QuadVector d = w.curve.centre - centre;
      const Quad d2 = dot(d, d);
      const Quad share = (rho2 - w.r2 + d2) / (2 * d2);
      foot = centre + share * d;
      along = (1 / root(d2)) * left(d);
      half2 = rho2 - share * share * d2;
    }
    if (half2 < 0) return {};
    const Quad half = root(half2);
    std::vector<Quad> times;
    for (const Quad& sign : {Quad(1), Quad(-1)}) {
      const QuadVector to = (foot + (sign * half) * along) - centre, from = now_.position - centre;
      // Clockwise for a positive omega.
      const Quad turn = omega_ > 0 ? cross(to, from) : cross(from, to);
      Quad angle = tests::angle(turn, dot(from, to));
      if (angle < 0) angle += 8 * tests::angle(1, 1);
      times.push_back(angle / magnitude(omega_));
    }
    return times;
  }

  Quad omega_;
  std::vector<QuadWall> walls_;
  QuadHit now_;
};

}  // namespace carom::tests
