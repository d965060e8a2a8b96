// Deviations of a group of particles that are followed together: two of them, or a whole frame of
// as many as the phase space has dimensions (Benettin, Galgani, Giorgilli & Strelcyn 1980).
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "carom/events/event.hpp"
#include "carom/geometry/curve_frame.hpp"
#include "carom/motion/tangent.hpp"
#include "carom/system/system.hpp"

namespace carom::engines {

/// What is asked of a group.
enum class Deviations {
  two,   ///< the largest exponent; lengths are sums of |dx|^2 + (unit |dv|)^2
  frame  ///< all exponents; lengths are those in which areas of phase space are seen at right
         ///< angles
};

class GroupTangent {
 public:
  virtual ~GroupTangent() = default;
  GroupTangent(const GroupTangent&) = delete;
  GroupTangent& operator=(const GroupTangent&) = delete;

  /// `states`: of all particles. `unit`: the time that makes a velocity a length.
  virtual void begin(std::span<const State> states, double unit) = 0;
  /// Carries deviations there and makes them orthogonal. `stopped`, asked now and then, ends it by
  /// SamplingStopped.
  virtual void fly_to(const Time&, const std::function<bool()>& stopped) = 0;
  /// Carries what a hit or a contact of a member at that time needs.
  virtual void arrive(std::size_t particle, const Time&, const std::function<bool()>& stopped) = 0;
  /// Where a member is at the time of arrival, if that is known better.
  virtual void put(std::size_t /*particle*/, const State&) {}
  /// A member that has arrived at a wall leaves it in this state.
  virtual void hit(std::size_t particle, const State&) = 0;
  /// Two members that have arrived touch each other.
  virtual void contact(const ContactEvent&) {}

  /// ln of the lengths; in a frame the i-th is that of the growth of volumes of i dimensions over
  /// that of volumes of i - 1.
  std::span<const double> logarithms() const { return logarithms_; }
  const std::vector<std::size_t>& members() const { return members_; }

 protected:
  /// Refers to the system. `members`: indices of its particles.
  GroupTangent(const System&, std::vector<std::size_t> members, Deviations);

  std::size_t size() const { return members_.size(); }
  std::size_t count() const { return logarithms_.size(); }
  const std::vector<Particle>& particles() const { return particles_; }
  std::size_t member_of(std::size_t particle) const;

  // Of all deviations one after the other, each of all members.
  void start_deviations(std::span<geometry::Vector> position, std::span<geometry::Vector> velocity,
                        double unit);
  void make_orthogonal(std::span<geometry::Vector> position, std::span<geometry::Vector> velocity);

  /// How a member is reflected that leaves a wall in this state.
  ReflectionTangent reflection(std::size_t member, const State&) const;

 private:
  void start_frame(std::span<geometry::Vector> position, std::span<geometry::Vector> velocity);

  const std::vector<std::size_t> members_;
  std::vector<Particle> particles_;
  std::vector<geometry::CurveFrame> walls_;
  // Lengths: sum of weight (|dx|^2 + unit^2 |dv - turn J dx|^2).
  double unit_ = 1.0;
  std::vector<double> weight_, turn_;
  std::vector<double> logarithms_;
};

}  // namespace carom::engines
