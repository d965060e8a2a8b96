// Deviations of particles under forces, by the scheme itself: a step is applied to the particles
// and, by its derivative, to their deviations.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "carom/integrators/stepper.hpp"
#include "carom/motion/tangent.hpp"
#include "carom/system/system.hpp"
#include "engines/group_tangent.hpp"

namespace carom::engines {

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

/// Of one particle alone, or of all that interact. The path between events is that of the scheme,
/// with steps that end at the multiples of its length.
class ForceTangent : public GroupTangent {
 public:
  ForceTangent(const System&, std::vector<std::size_t> members,
               Deviations deviations = Deviations::two);

  void begin(std::span<const State> states, double unit) override;
  void fly_to(const Time&, const std::function<bool()>& stopped) override;
  void arrive(std::size_t, const Time& time, const std::function<bool()>& stopped) override {
    fly_to(time, stopped);
  }
  void put(std::size_t particle, const State&) override;
  void hit(std::size_t particle, const State&) override;
  /// One of the deviations, over its length.
  Deviation direction(std::size_t particle, std::size_t deviation = 0) const {
    const std::size_t i = (deviation + 1) * size() + member_of(particle);
    return {phase_.position[i], phase_.velocity[i]};
  }

 private:
  void step(double duration);
  void make_orthogonal();

  const double step_;
  TangentLaw law_;
  std::vector<double> omega_;
  std::unique_ptr<Stepper<double>> stepper_;
  Phase<double> phase_, next_;
  Time time_;
};

}  // namespace carom::engines
