#include "engines/group_tangent.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>

#include "carom/base/elementary.hpp"

namespace carom::engines {

using geometry::Vector;

GroupTangent::GroupTangent(const System& system, std::vector<std::size_t> members,
                           Deviations deviations)
    : members_(std::move(members)) {
  const bool frame = deviations == Deviations::frame;
  for (const std::size_t i : members_) particles_.push_back(system.particles.at(i));
  // The momentum is m (dv - (omega/2) J dx) in the symmetric gauge: with it, areas of phase space
  // are those of pairs of coordinates.
  for (const Particle& p : particles_) {
    weight_.push_back(frame ? p.mass : 1.0);
    turn_.push_back(frame ? 0.5 * p.omega : 0.0);
  }
  for (const Wall& wall : system.table->walls) walls_.push_back(geometry::frame_of(wall.curve));
  logarithms_.resize(frame ? 4 * size() : 2);
}

std::size_t GroupTangent::member_of(std::size_t particle) const {
  return static_cast<std::size_t>(std::find(members_.begin(), members_.end(), particle) -
                                  members_.begin());
}

void GroupTangent::start_deviations(std::span<Vector> x, std::span<Vector> v, double unit) {
  const std::size_t n = size();
  unit_ = unit;
  for (std::size_t i = 0; i < n; ++i) {
    // Unlike numbers, so that no symmetry of the system is one of the deviations.
    const double uneven = 1.0 / static_cast<double>(i + 1);
    x[i] = {0.6 * uneven, 0.5};
    v[i] = (1.0 / unit) * Vector{0.3, -0.4 * uneven};
    x[n + i] = {-0.2, 0.7 * uneven};
    v[n + i] = (1.0 / unit) * Vector{0.5 * uneven, 0.1};
  }
  if (count() > 2) start_frame(x, v);
  make_orthogonal(x, v);
  std::fill(logarithms_.begin(), logarithms_.end(), 0.0);
}

// Completes the first deviation to a frame in which areas of phase space are those of the pairs
// (first, last), (second, last but one) … alone. Such a frame stays one when it is carried by a map
// that keeps areas and made orthogonal, so the exponents of each pair add up to 0 at all times.
// With q + i p as complex numbers, it is an orthonormal basis and i times the same.
void GroupTangent::start_frame(std::span<Vector> x, std::span<Vector> v) {
  using Complex = std::complex<double>;
  const std::size_t n = size(), half = 2 * n;
  std::vector<std::vector<Complex>> basis;
  std::vector<Complex> one(half);
  for (std::size_t i = 0; i < n; ++i) {
    const double scale = std::sqrt(weight_[i]);
    const Vector p = unit_ * (v[i] - turn_[i] * right(x[i]));
    one[2 * i] = scale * Complex(x[i].x, p.x);
    one[2 * i + 1] = scale * Complex(x[i].y, p.y);
  }
  for (std::size_t k = 0; k < half; ++k) {
    if (k > 0) {
      one.assign(half, 0.0);
      one[k] = 1.0;
    }
    // Twice, so that what is left is orthogonal to rounding.
    for (int pass = 0; pass < 2; ++pass)
      for (const std::vector<Complex>& other : basis) {
        Complex part = 0.0;
        for (std::size_t j = 0; j < half; ++j) part += std::conj(other[j]) * one[j];
        for (std::size_t j = 0; j < half; ++j) one[j] -= part * other[j];
      }
    double square = 0.0;
    for (const Complex& z : one) square += std::norm(z);
    for (Complex& z : one) z /= std::sqrt(square);
    basis.push_back(one);
  }
  const auto set = [&](std::size_t k, const std::vector<Complex>& z, Complex factor) {
    for (std::size_t i = 0; i < n; ++i) {
      const double scale = 1.0 / std::sqrt(weight_[i]);
      const Complex a = factor * z[2 * i], b = factor * z[2 * i + 1];
      x[k * n + i] = scale * Vector{a.real(), b.real()};
      v[k * n + i] = (scale / unit_) * Vector{a.imag(), b.imag()} + turn_[i] * right(x[k * n + i]);
    }
  };
  for (std::size_t k = 0; k < half; ++k) {
    set(k, basis[k], 1.0);
    set(2 * half - 1 - k, basis[k], {0.0, 1.0});
  }
}

// Gram and Schmidt: lengths go into the logarithms.
void GroupTangent::make_orthogonal(std::span<Vector> x, std::span<Vector> v) {
  const std::size_t n = size();
  const double square = unit_ * unit_;
  const auto turn_by = [&](double sign) {
    for (std::size_t k = 0; k < count(); ++k)
      for (std::size_t i = 0; i < n; ++i)
        if (turn_[i] != 0.0) v[k * n + i] = v[k * n + i] + (sign * turn_[i]) * right(x[k * n + i]);
  };
  turn_by(-1.0);
  const auto product = [&](std::size_t a, std::size_t b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < n; ++i)
      sum +=
          weight_[i] * (dot(x[a * n + i], x[b * n + i]) + square * dot(v[a * n + i], v[b * n + i]));
    return sum;
  };
  for (std::size_t k = 0; k < count(); ++k) {
    for (std::size_t before = 0; before < k; ++before) {
      const double part = product(k, before);
      for (std::size_t i = 0; i < n; ++i) {
        x[k * n + i] = x[k * n + i] - part * x[before * n + i];
        v[k * n + i] = v[k * n + i] - part * v[before * n + i];
      }
    }
    const double length = std::sqrt(product(k, k)), inverse = 1.0 / length;
    for (std::size_t i = 0; i < n; ++i) {
      x[k * n + i] = inverse * x[k * n + i];
      v[k * n + i] = inverse * v[k * n + i];
    }
    logarithms_[k] += elementary::log(length);
  }
  turn_by(1.0);
}

ReflectionTangent GroupTangent::reflection(std::size_t member, const State& state) const {
  const geometry::CurveFrame& wall = walls_[static_cast<std::size_t>(state.wall)];
  const Vector normal = geometry::normal_at(wall, state.u), v = state.velocity,
               before = v - (2.0 * dot(normal, v)) * normal;
  const double curvature = geometry::curvature_at(wall, state.u);
  const Particle& particle = particles_[member];
  // The centre of a disc meets the curve at the distance of its radius.
  return reflection_tangent(normal, curvature / (1.0 - curvature * particle.radius), before,
                            particle.omega);
}

}  // namespace carom::engines
