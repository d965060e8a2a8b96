// Deviations of particles under forces, by the scheme itself: a step is applied to the particles
// and, by its derivative, to their deviations.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "carom/ensemble/system.hpp"
#include "carom/geometry/curve_frame.hpp"
#include "carom/integrators/stepper.hpp"
#include "carom/motion/tangent.hpp"

namespace carom::ensemble {

/// Free motion is linear, and so is what a kick adds to deviations: dv' = -(1/m) H dx. So
/// deviations are further particles of the same step, which this law accelerates. The particles
/// come first, then each deviation of all of them.
class TangentLaw : public ForceLaw<double> {
 public:
  TangentLaw(const ForceField&, const geometry::Lattice*, std::vector<Particle>);
  void accelerations(std::span<const geometry::Vector> position,
                     std::span<geometry::Vector> acceleration) const override;
  /// Of the particles alone.
  void accelerate(std::span<const geometry::Vector> position,
                  std::span<geometry::Vector> acceleration) const;
  const std::vector<Particle>& particles() const { return particles_; }

 private:
  std::vector<geometry::Vector> folded(std::span<const geometry::Vector>) const;

  const ForceField& forces_;
  const geometry::Lattice* lattice_;
  geometry::Vector centre_;
  std::vector<Particle> particles_;
};

/// Two deviations of a group of particles: one alone, or all that interact. The path between events
/// is that of the scheme, with steps that end at the multiples of its length.
class ForceTangent {
 public:
  /// Refers to the system. `members`: indices of its particles.
  ForceTangent(const System& system, std::vector<std::size_t> members);

  /// `states`: of all particles. `unit`: the time that makes a velocity a length.
  void begin(std::span<const State> states, double unit);
  /// Steps to that time. `stopped`, asked now and then, ends it by SamplingStopped.
  void fly_to(const Time&, const std::function<bool()>& stopped);
  /// A member has hit a wall there and leaves it with this velocity; the path has come to that
  /// time.
  void hit(std::size_t particle, const State&);
  /// Where a member is at the path's time, if that is known better.
  void put(std::size_t particle, const State&);
  /// ln of the length of the first deviation.
  double logarithm() const { return logarithms_[0]; }
  /// It, over its length.
  Deviation direction(std::size_t particle) const {
    const std::size_t i = size() + member_of(particle);
    return {phase_.position[i], phase_.velocity[i]};
  }
  const std::vector<std::size_t>& members() const { return members_; }

 private:
  std::size_t member_of(std::size_t particle) const;
  std::size_t size() const { return members_.size(); }
  void step(double duration);
  void make_orthogonal();

  static constexpr std::size_t deviations = 2;

  const System& system_;
  std::vector<std::size_t> members_;
  TangentLaw law_;
  std::vector<double> omega_;
  std::unique_ptr<Stepper<double>> stepper_;
  std::vector<geometry::CurveFrame> walls_;
  Phase<double> phase_, next_;
  Time time_;
  double unit_ = 1.0;
  double logarithms_[deviations] = {};
};

}  // namespace carom::ensemble
