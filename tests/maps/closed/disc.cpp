#include <cmath>

#include "maps/closed/maps.hpp"

namespace carom::maps {

// Let e be the direction of the hit from the centre and t the tangent, e turned counter-clockwise.
// The outgoing velocity is along -cos(beta) e + sin(beta) t, and the centre of a clockwise Larmor
// circle is at (R + rho sin beta) e + rho cos(beta) t. The next hit is the mirror image of this one
// in the line through both centres, which gives theta; the angle at the centre of the Larmor circle
// gives the time in the same way, with the circles exchanged. A counter-clockwise field is the
// mirror image.
template <class Real>
DiscHit<Real> Disc<Real>::after(const DiscHit<Real>& hit, std::uint64_t n) const {
  const Real count = static_cast<Real>(n);
  if (omega_ == 0) {
    const Real advance = pi<Real> - 2 * hit.beta;
    return {hit.theta + count * advance, hit.beta,
            hit.time + count * (2 * radius_ * std::cos(hit.beta) / speed_)};
  }
  const Real turn = omega_ > 0 ? 1 : -1;
  const Real rho = speed_ / std::abs(omega_);
  const Real sine = turn * std::sin(hit.beta), cosine = std::cos(hit.beta);
  const Real advance = 2 * std::atan2(rho * cosine, radius_ + rho * sine);
  const Real sweep = 2 * std::atan2(radius_ * cosine, rho + radius_ * sine);
  return {hit.theta + turn * count * advance, hit.beta,
          hit.time + count * (sweep / std::abs(omega_))};
}

template <class Real>
Phase<Real> Disc<Real>::phase(const DiscHit<Real>& hit) const {
  const Real c = std::cos(hit.theta), s = std::sin(hit.theta);
  const Real inward = speed_ * std::cos(hit.beta), along = speed_ * std::sin(hit.beta);
  return {radius_ * c, radius_ * s, -inward * c - along * s, -inward * s + along * c};
}

// The conserved momentum is R v sin(beta) + omega R^2/2 at the wall, which gives beta; there is a
// hit where the sine is one. The velocity arrives along cos(beta) e + sin(beta) t, and the centre
// of a clockwise Larmor circle is then at (R + rho sin beta) e - rho cos(beta) t: its angle gives
// theta. Every step is well conditioned for weak fields too.
template <class Real>
std::optional<DiscHit<Real>> Disc<Real>::first_hit(const Phase<Real>& start) const {
  const Real momentum = canonical_angular_momentum(start, omega_);
  const Real sine = (momentum - omega_ * radius_ * radius_ / 2) / (radius_ * speed_);
  if (!(std::abs(sine) < 1)) return std::nullopt;
  const Real cosine = std::sqrt((1 - sine) * (1 + sine));
  const Real beta = std::atan2(sine, cosine);
  const Real direction = std::atan2(start.vy, start.vx);
  if (omega_ == 0) {
    const Real length = radius_ * cosine - (start.x * start.vx + start.y * start.vy) / speed_;
    return DiscHit<Real>{direction - beta, beta, length / speed_};
  }
  const Real turn = omega_ > 0 ? 1 : -1;
  const Real rho = speed_ / std::abs(omega_);
  const Real centre = std::atan2(start.y - start.vx / omega_, start.x + start.vy / omega_);
  const Real theta = centre + turn * std::atan2(rho * cosine, radius_ + turn * rho * sine);
  const Real two_pi = 2 * pi<Real>;
  Real sweep = std::fmod(turn * (direction - theta - beta), two_pi);
  if (sweep < 0) sweep += two_pi;
  return DiscHit<Real>{theta, beta, sweep / std::abs(omega_)};
}

template class Disc<double>;
template class Disc<long double>;

}  // namespace carom::maps
