#include <array>
#include <cmath>

#include "maps/closed/maps.hpp"

namespace carom::maps {
namespace {

template <class Real>
constexpr Real two_pi = 2 * pi<Real>;

// The turn from one direction to another in the sense of the field, in [0, 2 pi).
template <class Real>
Real turn(Real from, Real to, Real omega) {
  Real angle = std::fmod(omega > 0 ? from - to : to - from, two_pi<Real>);
  if (angle < 0) angle += two_pi<Real>;
  return angle < two_pi<Real> ? angle : 0;  // the sum may have rounded up
}

// A mirror changes the sign of one component of the velocity.
template <class Real>
Real mirrored(Side side, Real angle) {
  const bool horizontal = side == Side::bottom || side == Side::top;
  return std::remainder(horizontal ? -angle : pi<Real> - angle, two_pi<Real>);
}

}  // namespace

// With the velocity at the angle a, a particle is at (c_x - r sin a, c_y + r cos a), r =
// speed/omega with its sign. Each side is met outwards at one angle: to the right where cos a > 0,
// and so on. The rectangle is convex, so the first of the four is the hit. The side just left is
// met again at the mirror image of the angle with which it was left: no root near zero has to be
// told from zero.
template <class Real>
std::optional<Gyration<Real>> MagneticRectangle<Real>::arrive(const Gyration<Real>& from) const {
  const Real r = speed_ / omega_;
  const Real cx = from.x + r * std::sin(from.angle), cy = from.y - r * std::cos(from.angle);
  // sin a on the vertical sides, cos a on the horizontal ones, in the order of Side.
  const std::array<Real, 4> ratio = {-cy / r, (cx - width_) / r, (height_ - cy) / r, cx / r};
  Real least = 0, angle = 0;
  Side side = Side::none;
  for (int i = 0; i < 4; ++i) {
    const Side s = static_cast<Side>(i);
    const Real q = ratio[static_cast<std::size_t>(i)];
    Real a = 0;
    if (s == from.side) {
      a = mirrored(s, from.angle);
    } else if (!(std::abs(q) < 1)) {
      continue;  // the Larmor circle does not reach the side's line
    } else if (s == Side::right) {
      a = std::asin(q);
    } else if (s == Side::left) {
      a = pi<Real> - std::asin(q);
    } else {
      a = s == Side::top ? std::acos(q) : -std::acos(q);
    }
    const Real sweep = turn(from.angle, a, omega_);
    if (side != Side::none && sweep >= least) continue;
    least = sweep;
    angle = a;
    side = s;
  }
  if (side == Side::none) return std::nullopt;
  Gyration<Real> hit{
      cx - r * std::sin(angle), cy + r * std::cos(angle), angle, side, 0, from.hits + 1};
  if (side == Side::left) hit.x = 0;
  if (side == Side::right) hit.x = width_;
  if (side == Side::bottom) hit.y = 0;
  if (side == Side::top) hit.y = height_;
  hit.time = from.time + least / std::abs(omega_);
  return hit;
}

template <class Real>
std::optional<Gyration<Real>> MagneticRectangle<Real>::next(const Gyration<Real>& from) const {
  auto hit = arrive(from);
  if (hit) hit->angle = mirrored(hit->side, hit->angle);
  return hit;
}

template <class Real>
Real MagneticRectangle<Real>::arc_length(const Gyration<Real>& hit) const {
  switch (hit.side) {
    case Side::bottom:
      return hit.x;
    case Side::right:
      return hit.y;
    case Side::top:
      return width_ - hit.x;
    default:
      return height_ - hit.y;
  }
}

template <class Real>
Departure<Real> MagneticRectangle<Real>::escape(const Opening<Real>& hole, Real x, Real y,
                                                Real angle, Real t_max) const {
  Gyration<Real> particle{x, y, angle};
  while (true) {
    const auto hit = arrive(particle);
    if (!hit) return {false, true, t_max, 0};
    if (hit->time > t_max) return {false, false, t_max, particle.hits};
    const Real s = arc_length(*hit);
    if (hit->side == hole.side && hole.from <= s && s < hole.to) {
      return {true, false, hit->time, particle.hits};
    }
    particle = *hit;
    particle.angle = mirrored(hit->side, hit->angle);
  }
}

template class MagneticRectangle<double>;
template class MagneticRectangle<long double>;

}  // namespace carom::maps
