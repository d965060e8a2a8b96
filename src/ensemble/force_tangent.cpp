#include "ensemble/force_tangent.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "carom/base/elementary.hpp"
#include "carom/base/error.hpp"
#include "carom/ensemble/sampler.hpp"
#include "carom/forces/hessian.hpp"
#include "carom/integrators/make_stepper.hpp"
#include "carom/integrators/scheme.hpp"
#include "carom/motion/tangent.hpp"
#include "forces/nearest_copy.hpp"

namespace carom::ensemble {

using geometry::Vector;

namespace {

Vector times(const Hessian& h, const Vector& d) {
  return {h.xx * d.x + h.xy * d.y, h.xy * d.x + h.yy * d.y};
}

std::vector<Particle> some(const std::vector<Particle>& all,
                           const std::vector<std::size_t>& members) {
  std::vector<Particle> list;
  for (const std::size_t i : members) list.push_back(all.at(i));
  return list;
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

ForceTangent::ForceTangent(const System& system, std::vector<std::size_t> members)
    : system_(system),
      members_(std::move(members)),
      law_(*system.dynamics.forces, system.table->lattice ? &*system.table->lattice : nullptr,
           some(system.particles, members_)) {
  for (std::size_t copy = 0; copy <= deviations; ++copy)
    for (const Particle& p : law_.particles()) omega_.push_back(p.omega);
  stepper_ = make_stepper(system.dynamics.integrator, law_, omega_);
  for (const Wall& wall : system.table->walls) walls_.push_back(geometry::frame_of(wall.curve));
}

void ForceTangent::begin(std::span<const State> states, double unit) {
  const std::size_t n = size();
  stepper_->forget();
  time_ = states[members_.front()].time;
  unit_ = unit;
  phase_.position.assign((deviations + 1) * n, {});
  phase_.velocity.assign((deviations + 1) * n, {});
  for (std::size_t i = 0; i < n; ++i) {
    const State& state = states[members_[i]];
    phase_.position[i] = state.position;
    phase_.velocity[i] = state.velocity;
    // Unlike numbers, so that no symmetry of the system is one of the deviations.
    const double uneven = 1.0 / static_cast<double>(i + 1);
    phase_.position[n + i] = {0.6 * uneven, 0.5};
    phase_.velocity[n + i] = (1.0 / unit) * Vector{0.3, -0.4 * uneven};
    phase_.position[2 * n + i] = {-0.2, 0.7 * uneven};
    phase_.velocity[2 * n + i] = (1.0 / unit) * Vector{0.5 * uneven, 0.1};
  }
  make_orthogonal();
  for (double& logarithm : logarithms_) logarithm = 0.0;
}

// Gram and Schmidt: lengths go into the logarithms.
void ForceTangent::make_orthogonal() {
  const std::size_t n = size();
  const double square = unit_ * unit_;
  const auto product = [&](std::size_t a, std::size_t b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < n; ++i)
      sum += dot(phase_.position[a * n + i], phase_.position[b * n + i]) +
             square * dot(phase_.velocity[a * n + i], phase_.velocity[b * n + i]);
    return sum;
  };
  for (std::size_t k = 1; k <= deviations; ++k) {
    for (std::size_t before = 1; before < k; ++before) {
      const double part = product(k, before);
      for (std::size_t i = 0; i < n; ++i) {
        phase_.position[k * n + i] =
            phase_.position[k * n + i] - part * phase_.position[before * n + i];
        phase_.velocity[k * n + i] =
            phase_.velocity[k * n + i] - part * phase_.velocity[before * n + i];
      }
    }
    const double length = std::sqrt(product(k, k)), inverse = 1.0 / length;
    for (std::size_t i = 0; i < n; ++i) {
      phase_.position[k * n + i] = inverse * phase_.position[k * n + i];
      phase_.velocity[k * n + i] = inverse * phase_.velocity[k * n + i];
    }
    logarithms_[k - 1] += elementary::log(length);
  }
}

void ForceTangent::step(double duration) {
  stepper_->step(phase_, duration, next_);
  std::swap(phase_, next_);
}

void ForceTangent::fly_to(const Time& end, const std::function<bool()>& stopped) {
  const double h = system_.dynamics.integrator.step;
  // Between steps deviations stay far from the ends of the doubles' range.
  constexpr int steps_between = 8;
  for (std::uint64_t k = 1; time_ < end; ++k) {
    double number = std::floor(time_.value() / h) + 1.0;
    while (!(Time(number * h) > time_)) number += 1.0;  // the quotient was rounded down
    const Time to = Time(number * h) < end ? Time(number * h) : end;
    step(to - time_);
    time_ = to;
    if (k % steps_between == 0) make_orthogonal();
    if (k % 1024 == 0 && stopped && stopped()) throw SamplingStopped();
  }
  make_orthogonal();
}

std::size_t ForceTangent::member_of(std::size_t particle) const {
  return static_cast<std::size_t>(std::find(members_.begin(), members_.end(), particle) -
                                  members_.begin());
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
  const geometry::CurveFrame& wall = walls_[static_cast<std::size_t>(state.wall)];
  const Vector normal = geometry::normal_at(wall, state.u), v = state.velocity,
               before = v - (2.0 * dot(normal, v)) * normal;
  const ReflectionTangent map = reflection_tangent(normal, geometry::curvature_at(wall, state.u),
                                                   before, law_.particles()[member].omega);
  // The nearby orbit is reflected later by -(n . dx)/(n . v): so long its acceleration by the
  // forces was the mirrored one.
  const double jump = 2.0 * dot(normal, acceleration[member]) / dot(normal, before);
  for (std::size_t k = 1; k <= deviations; ++k) {
    Vector &x = phase_.position[k * n + member], &w = phase_.velocity[k * n + member];
    const Deviation after = map({x, w});
    w = after.velocity + (jump * dot(normal, x)) * normal;
    x = after.position;
  }
  phase_.position[member] = state.position;
  phase_.velocity[member] = state.velocity;
  make_orthogonal();
}

}  // namespace carom::ensemble
