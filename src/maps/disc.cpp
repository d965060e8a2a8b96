#include <cmath>
#include <numbers>

#include "carom/maps/maps.hpp"

namespace carom::maps {

// Let e be the direction of the hit from the centre and t the tangent, e turned counter-clockwise. The
// outgoing velocity is along -cos(beta) e + sin(beta) t, and the centre of a clockwise Larmor circle
// is at (R + rho sin beta) e + rho cos(beta) t. The next hit is the mirror image of this one in the
// line through both centres, which gives theta; the angle at the centre of the Larmor circle gives the
// time in the same way, with the circles exchanged. A counter-clockwise field is the mirror image.
template <class Real>
DiscHit<Real> Disc<Real>::after(const DiscHit<Real>& hit, std::uint64_t n) const {
  const Real count = static_cast<Real>(n);
  if (omega_ == 0) {
    const Real advance = std::numbers::pi_v<Real> - 2 * hit.beta;
    return {hit.theta + count * advance, hit.beta,
            hit.time + count * (2 * radius_ * std::cos(hit.beta) / speed_)};
  }
  const Real turn = omega_ > 0 ? 1 : -1;
  const Real rho = speed_ / std::abs(omega_);
  const Real sine = turn * std::sin(hit.beta), cosine = std::cos(hit.beta);
  const Real advance = 2 * std::atan2(rho * cosine, radius_ + rho * sine);
  const Real sweep = 2 * std::atan2(radius_ * cosine, rho + radius_ * sine);
  return {hit.theta + turn * count * advance, hit.beta, hit.time + count * (sweep / std::abs(omega_))};
}

template <class Real>
Phase<Real> Disc<Real>::phase(const DiscHit<Real>& hit) const {
  const Real c = std::cos(hit.theta), s = std::sin(hit.theta);
  const Real inward = speed_ * std::cos(hit.beta), along = speed_ * std::sin(hit.beta);
  return {radius_ * c, radius_ * s, -inward * c - along * s, -inward * s + along * c};
}

template <class Real>
std::optional<DiscHit<Real>> Disc<Real>::first_hit(const Phase<Real>& start) const {
  Real x = 0, y = 0, vx = start.vx, vy = start.vy, time = 0;
  if (omega_ == 0) {
    const Real along = (start.x * vx + start.y * vy) / speed_;
    const Real across = (start.x * vy - start.y * vx) / speed_;
    const Real length = std::sqrt(radius_ * radius_ - across * across) - along;
    x = start.x + length * vx / speed_;
    y = start.y + length * vy / speed_;
    time = length / speed_;
  } else {
    const Real turn = omega_ > 0 ? 1 : -1;
    const Real rho = speed_ / std::abs(omega_);
    const Real cx = start.x + vy / omega_, cy = start.y - vx / omega_;
    const Real d = std::hypot(cx, cy);
    if (d + rho < radius_ || d + radius_ < rho) return std::nullopt;
    // Angles about the Larmor centre, counted from the side that faces away from the disc's centre and
    // growing with the motion: the particle is outside the disc from -half to half.
    const Real half = std::acos((radius_ * radius_ - rho * rho - d * d) / (2 * rho * d));
    const Real now = turn * (std::atan2(cy, cx) - std::atan2(start.y - cy, start.x - cx));
    const Real two_pi = 2 * std::numbers::pi_v<Real>;
    Real sweep = std::fmod(-half - now, two_pi);
    if (sweep < 0) sweep += two_pi;
    time = sweep / std::abs(omega_);
    const Real c = std::cos(omega_ * time), s = std::sin(omega_ * time);
    vx = c * start.vx + s * start.vy;
    vy = -s * start.vx + c * start.vy;
    x = cx - vy / omega_;
    y = cy + vx / omega_;
  }
  const Real theta = std::atan2(y, x);
  const Real outward = vx * std::cos(theta) + vy * std::sin(theta);
  const Real along = vy * std::cos(theta) - vx * std::sin(theta);
  return DiscHit<Real>{theta, std::atan2(along, outward), time};
}

template class Disc<double>;
template class Disc<long double>;

}  // namespace carom::maps
