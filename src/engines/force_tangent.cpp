#include "engines/force_tangent.hpp"

#include <cmath>
#include <utility>

#include "carom/forces/hessian.hpp"
#include "carom/integrators/make_stepper.hpp"
#include "carom/integrators/scheme.hpp"
#include "carom/starts/sampler.hpp"
#include "forces/nearest_copy.hpp"

namespace carom::engines {

using geometry::Vector;

namespace {

Vector times(const Hessian& h, const Vector& d) {
  return {h.xx * d.x + h.xy * d.y, h.xy * d.x + h.yy * d.y};
}

}  // namespace

TangentLaw::TangentLaw(const ForceField& forces, const geometry::Lattice* lattice,
                       std::vector<Particle> particles)
    : forces_(forces), lattice_(lattice), particles_(std::move(particles)) {
  if (!lattice_) return;
  for (const geometry::CellEdge& e : lattice_->edges) centre_ = centre_ + e.segment.from;
  centre_ = (1.0 / static_cast<double>(lattice_->edges.size())) * centre_;
}

std::vector<Vector> TangentLaw::folded(std::span<const Vector> x) const {
  std::vector<Vector> in_cell(x.begin(),
                              x.begin() + static_cast<std::ptrdiff_t>(particles_.size()));
  if (lattice_)
    for (Vector& one : in_cell) one = centre_ + forces::nearest_copy(one - centre_, *lattice_);
  return in_cell;
}

void TangentLaw::accelerate(std::span<const Vector> position, std::span<Vector> a) const {
  const std::vector<Vector> x = folded(position);
  for (std::size_t i = 0; i < x.size(); ++i) {
    a[i] = {};
    if (forces_.external()) forces_.add_external(particles_[i], x[i], a[i]);
  }
  if (forces_.interacts()) forces_.add_pairs(particles_, x, lattice_, a);
  for (std::size_t i = 0; i < x.size(); ++i)
    if (particles_[i].mass != 1.0) a[i] = (1.0 / particles_[i].mass) * a[i];
}

void TangentLaw::accelerations(std::span<const Vector> position, std::span<Vector> a) const {
  const std::size_t n = particles_.size(), copies = position.size() / n;
  accelerate(position, a.first(n));
  const std::vector<Vector> x = folded(position);
  for (std::size_t k = n; k < a.size(); ++k) a[k] = {};
  const auto add = [&](std::size_t copy, std::size_t i, const Hessian& h, const Vector& d) {
    Vector& sum = a[copy * n + i];
    sum = sum - (1.0 / particles_[i].mass) * times(h, d);
  };
  for (std::size_t i = 0; i < n; ++i) {
    if (forces_.external()) {
      Hessian h;
      forces_.add_external_hessian(particles_[i], x[i], h);
      for (std::size_t copy = 1; copy < copies; ++copy) add(copy, i, h, position[copy * n + i]);
    }
    for (std::size_t j = 0; forces_.interacts() && j < i; ++j) {
      Hessian h;
      const Vector d = lattice_ ? forces::nearest_copy(x[i] - x[j], *lattice_) : x[i] - x[j];
      forces_.add_pair_hessian(particles_[i], particles_[j], d, h);
      for (std::size_t copy = 1; copy < copies; ++copy) {
        const Vector apart = position[copy * n + i] - position[copy * n + j];
        add(copy, i, h, apart);
        add(copy, j, h, -apart);
      }
    }
  }
}

ForceTangent::ForceTangent(const System& system, std::vector<std::size_t> members,
                           Deviations deviations)
    : GroupTangent(system, std::move(members), deviations),
      step_(system.dynamics.integrator.step),
      law_(*system.dynamics.forces, system.table->lattice ? &*system.table->lattice : nullptr,
           particles()) {
  for (std::size_t copy = 0; copy <= count(); ++copy)
    for (const Particle& p : particles()) omega_.push_back(p.omega);
  stepper_ = make_stepper(system.dynamics.integrator, law_, omega_);
}

void ForceTangent::begin(std::span<const State> states, double unit) {
  const std::size_t n = size();
  stepper_->forget();
  time_ = states[members().front()].time;
  phase_.position.assign((count() + 1) * n, {});
  phase_.velocity.assign((count() + 1) * n, {});
  for (std::size_t i = 0; i < n; ++i) {
    phase_.position[i] = states[members()[i]].position;
    phase_.velocity[i] = states[members()[i]].velocity;
  }
  start_deviations(std::span(phase_.position).subspan(n), std::span(phase_.velocity).subspan(n),
                   unit);
}

void ForceTangent::make_orthogonal() {
  GroupTangent::make_orthogonal(std::span(phase_.position).subspan(size()),
                                std::span(phase_.velocity).subspan(size()));
}

void ForceTangent::step(double duration) {
  stepper_->step(phase_, duration, next_);
  std::swap(phase_, next_);
}

void ForceTangent::fly_to(const Time& end, const std::function<bool()>& stopped) {
  // Between steps deviations stay far from the ends of the doubles' range.
  constexpr int steps_between = 8;
  for (std::uint64_t k = 1; time_ < end; ++k) {
    double number = std::floor(time_.value() / step_) + 1.0;
    while (!(Time(number * step_) > time_)) number += 1.0;  // the quotient was rounded down
    const Time to = Time(number * step_) < end ? Time(number * step_) : end;
    step(to - time_);
    time_ = to;
    if (k % steps_between == 0) make_orthogonal();
    if (k % 1024 == 0 && stopped && stopped()) throw SamplingStopped();
  }
  make_orthogonal();
}

void ForceTangent::put(std::size_t particle, const State& state) {
  phase_.position[member_of(particle)] = state.position;
  phase_.velocity[member_of(particle)] = state.velocity;
}

void ForceTangent::hit(std::size_t particle, const State& state) {
  const std::size_t n = size();
  const std::size_t member = member_of(particle);
  std::vector<Vector> acceleration(n);
  law_.accelerate(phase_.position, acceleration);
  const ReflectionTangent map = reflection(member, state);
  const Vector normal = map.normal;
  // The nearby orbit is reflected later by -(n . dx)/(n . v): so long its acceleration by the
  // forces was the mirrored one.
  const double jump =
      2.0 * dot(normal, acceleration[member]) / dot(normal, map.mirrored(state.velocity));
  for (std::size_t k = 1; k <= count(); ++k) {
    Vector &x = phase_.position[k * n + member], &w = phase_.velocity[k * n + member];
    const Deviation after = map({x, w});
    w = after.velocity + (jump * dot(normal, x)) * normal;
    x = after.position;
  }
  put(particle, state);
  make_orthogonal();
}

}  // namespace carom::engines
