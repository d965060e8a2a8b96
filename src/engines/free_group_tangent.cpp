#include "engines/free_group_tangent.hpp"

namespace carom::engines {

using geometry::Vector;

Deviation FreeGroupTangent::at(std::size_t deviation, std::size_t member) const {
  const std::size_t i = deviation * size() + member;
  return {position_[i], velocity_[i]};
}
void FreeGroupTangent::set(std::size_t deviation, std::size_t member, const Deviation& d) {
  const std::size_t i = deviation * size() + member;
  position_[i] = d.position;
  velocity_[i] = d.velocity;
}

void FreeGroupTangent::begin(std::span<const State> states, double unit) {
  unit_ = unit;
  events_ = 0;
  last_.assign(size(), states[members().front()].time);
  position_.assign(count() * size(), {});
  velocity_.assign(count() * size(), {});
  start_deviations(position_, velocity_, unit);
}

void FreeGroupTangent::fly(std::size_t member, const Time& time) {
  const FlightTangent map = flight_tangent(particles()[member].omega, time - last_[member]);
  for (std::size_t k = 0; k < count(); ++k) set(k, member, map(at(k, member)));
  last_[member] = time;
}

void FreeGroupTangent::fly_to(const Time& time, const std::function<bool()>&) {
  for (std::size_t i = 0; i < size(); ++i) fly(i, time);
  make_orthogonal(position_, velocity_);
  events_ = 0;
}

void FreeGroupTangent::arrive(std::size_t particle, const Time& time,
                              const std::function<bool()>&) {
  fly(member_of(particle), time);
}

void FreeGroupTangent::hit(std::size_t particle, const State& state) {
  const std::size_t member = member_of(particle);
  const ReflectionTangent map = reflection(member, state);
  for (std::size_t k = 0; k < count(); ++k) set(k, member, map(at(k, member)));
  settle(member);
}

void FreeGroupTangent::contact(const ContactEvent& e) {
  const std::size_t i = member_of(static_cast<std::size_t>(e.first)),
                    j = member_of(static_cast<std::size_t>(e.second));
  const Particle &a = particles()[i], &b = particles()[j];
  const ContactTangent map = contact_tangent(e.separation, e.first_before, e.second_before, a.mass,
                                             b.mass, a.omega, b.omega);
  for (std::size_t k = 0; k < count(); ++k) {
    Deviation first = at(k, i), second = at(k, j);
    map(first, second);
    set(k, i, first);
    set(k, j, second);
  }
  settle(i);
}

// Deviations are made orthogonal often enough that the shortest keep their digits beside the
// longest.
void FreeGroupTangent::settle(std::size_t member) {
  constexpr double most = 0x1p16;  // of a square: they differ by some 2^16 then
  const Deviation longest = at(0, member);
  const double square = dot(longest.position, longest.position) +
                        unit_ * unit_ * dot(longest.velocity, longest.velocity);
  if (++events_ >= size() || square > most) fly_to(last_[member], {});
}

}  // namespace carom::engines
