// Closed-form collision maps: a witness of the engine that shares nothing with it.
//
// Everything here is written from the formulas in angles and with the C library's trigonometry,
// while the engine works with rational parameters and signs. The conventions are those of Carom:
// the acceleration is omega (v_y, -v_x), so omega > 0 turns clockwise; the Larmor radius is
// speed/|omega|. Real is double or long double; the latter follows an orbit with eleven bits to
// spare.
//
// Sources: disc with a field: Robnik & Berry, J. Phys. A 18 (1985) 1361; rectangle with a field:
// Berglund & Kunz, J. Stat. Phys. 83 (1996) 81; ellipse: Berry, Eur. J. Phys. 2 (1981) 91.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace carom::maps {

/// libc++'s std::numbers::pi_v<long double> is a double.
template <class Real>
constexpr Real pi = static_cast<Real>(3.141592653589793238462643383279502884L);

/// Position and velocity.
template <class Real>
struct Phase {
  Real x, y, vx, vy;
};

/// A hit of a disc's wall: the angle of the point about the centre, the angle of the *outgoing*
/// velocity from the inward normal (sin beta > 0: counter-clockwise along the wall), the time.
template <class Real>
struct DiscHit {
  Real theta, beta, time;
};

/// The billiard in a disc about the origin, with or without a field.
template <class Real>
class Disc {
 public:
  Disc(Real radius, Real speed, Real omega) : radius_(radius), speed_(speed), omega_(omega) {}

  /// The next hit. beta is conserved. Without a field theta grows by pi - 2 beta, with a clockwise
  /// one by 2 atan2(rho cos beta, R + rho sin beta); the Larmor circle turns meanwhile by 2 atan2(R
  /// cos beta, rho + R sin beta). theta is not reduced to one turn.
  DiscHit<Real> next(const DiscHit<Real>& hit) const { return after(hit, 1); }
  /// The hit n collisions later, without the ones between.
  DiscHit<Real> after(const DiscHit<Real>& hit, std::uint64_t n) const;
  /// Point and outgoing velocity of a hit.
  Phase<Real> phase(const DiscHit<Real>& hit) const;
  /// The first hit of a particle inside, or nothing if its Larmor circle never meets the wall.
  std::optional<DiscHit<Real>> first_hit(const Phase<Real>& start) const;

 private:
  Real radius_, speed_, omega_;
};

/// Sides of the rectangle [0, width] x [0, height]; arc length runs bottom +x, right +y, top -x,
/// left -y.
enum class Side { none = -1, bottom = 0, right, top, left };

template <class Real>
struct SideHit {
  Side side;
  Real time;
  Phase<Real> phase;  ///< after the reflection
};

/// The rectangle without a field, by unfolding: the orbit is a straight line in a plane of mirror
/// images.
template <class Real>
class Rectangle {
 public:
  Rectangle(Real width, Real height) : width_(width), height_(height) {}

  /// Point and velocity at any time, past or future.
  Phase<Real> at(const Phase<Real>& start, Real time) const;
  /// The first `count` hits in order of time; two at a corner, the vertical side first.
  std::vector<SideHit<Real>> hits(const Phase<Real>& start, std::uint64_t count) const;

 private:
  Real width_, height_;
};

/// A particle in the magnetic rectangle: the point, the angle of the velocity against +x, the side
/// it has just left (none: it is inside), the time and the hits so far.
template <class Real>
struct Gyration {
  Real x, y, angle;
  Side side = Side::none;
  Real time = 0;
  std::uint64_t hits = 0;
};

/// An opening [from, to) of a side, in arc length along it.
template <class Real>
struct Opening {
  Side side;
  Real from, to;
};

template <class Real>
struct Departure {
  bool escaped = false;
  bool pinned = false;  ///< the Larmor circle never meets a wall
  Real time = 0;        ///< of the escape, else t_max
  std::uint64_t hits = 0;
};

/// The rectangle with a field (omega != 0).
template <class Real>
class MagneticRectangle {
 public:
  MagneticRectangle(Real width, Real height, Real speed, Real omega)
      : width_(width), height_(height), speed_(speed), omega_(omega) {}

  /// The next hit, with the velocity before its reflection; nothing for a pinned orbit.
  std::optional<Gyration<Real>> arrive(const Gyration<Real>& from) const;
  /// The next hit, reflected.
  std::optional<Gyration<Real>> next(const Gyration<Real>& from) const;
  /// Arc length of a hit along its side.
  Real arc_length(const Gyration<Real>& hit) const;
  /// Follows a particle from inside until it leaves through the opening or t_max has passed.
  Departure<Real> escape(const Opening<Real>& hole, Real x, Real y, Real angle, Real t_max) const;

 private:
  Real width_, height_, speed_, omega_;
};

/// Canonical angular momentum about the origin, x v_y - y v_x + omega (x^2 + y^2)/2: conserved in a
/// disc.
template <class Real>
Real canonical_angular_momentum(const Phase<Real>& p, Real omega) {
  return p.x * p.vy - p.y * p.vx + omega * (p.x * p.x + p.y * p.y) / 2;
}

/// Product of the angular momenta about the foci (+-sqrt(a^2 - b^2), 0) of the ellipse with
/// semi-axes a >= b: conserved without a field. Positive: the orbit touches an ellipse; negative: a
/// hyperbola.
template <class Real>
Real focal_product(Real a, Real b, const Phase<Real>& p);

}  // namespace carom::maps
