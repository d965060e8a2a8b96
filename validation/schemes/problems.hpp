// Forces in closed form, over any arithmetic, with starts, for measuring schemes.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "carom/integrators/arithmetic.hpp"
#include "carom/integrators/stepper.hpp"

namespace carom::problems {

/// A force law that also knows its potential and counts how often it is asked.
template <class Real>
class Problem : public ForceLaw<Real> {
 public:
  using Vector = geometry::BasicVector<Real>;

  void accelerations(std::span<const Vector> x, std::span<Vector> a) const final {
    ++evaluations;
    compute(x, a);
  }
  virtual Real potential(std::span<const Vector> x) const = 0;
  std::span<const Real> masses() const final {
    mass_.resize(omega.size(), Real(1));
    return mass_;
  }
  Real potential_energy(std::span<const Vector> x) const final { return potential(x); }

  Real energy(const Phase<Real>& phase) const {
    Real sum = potential(phase.position);
    for (const Vector& v : phase.velocity) sum = sum + dot(v, v) / Real(2);
    return sum;
  }

  std::string name;
  Phase<Real> start;
  std::vector<Real> omega;
  mutable long evaluations = 0;

 private:
  virtual void compute(std::span<const Vector> x, std::span<Vector> a) const = 0;
  mutable std::vector<Real> mass_;
};

template <class Real>
Real decimal(const char* text) {
  return Arithmetic<Real>::parse(text);
}

/// V = (x^2 + y^2)/2 + x^2 y - y^3/3, E = 1/8.
template <class Real>
class HenonHeiles final : public Problem<Real> {
 public:
  using typename Problem<Real>::Vector;
  explicit HenonHeiles(const char* frequency) {
    using std::sqrt;
    this->name = "Hénon–Heiles";
    this->omega = {decimal<Real>(frequency)};
    const Vector x{decimal<Real>("0.1"), decimal<Real>("-0.2")};
    this->start.position = {x};
    const Vector direction{decimal<Real>("0.8"), decimal<Real>("0.6")};
    const Real speed = sqrt(Real(2) * (Real(1) / Real(8) - potential(this->start.position)));
    this->start.velocity = {speed * direction};
  }
  Real potential(std::span<const Vector> x) const override {
    const Real xx = x[0].x * x[0].x, yy = x[0].y * x[0].y;
    return (xx + yy) / Real(2) + xx * x[0].y - yy * x[0].y / Real(3);
  }

 private:
  void compute(std::span<const Vector> x, std::span<Vector> a) const override {
    a[0] = {-(x[0].x + Real(2) * x[0].x * x[0].y), -(x[0].y + x[0].x * x[0].x - x[0].y * x[0].y)};
  }
};

/// V = (x^2 + 3 y^2 + x y)/2.
template <class Real>
class AnisotropicWell final : public Problem<Real> {
 public:
  using typename Problem<Real>::Vector;
  explicit AnisotropicWell(const char* frequency) {
    this->name = "anisotropic well";
    this->omega = {decimal<Real>(frequency)};
    this->start.position = {{decimal<Real>("0.7"), decimal<Real>("-0.3")}};
    this->start.velocity = {{decimal<Real>("0.2"), decimal<Real>("0.9")}};
  }
  Real potential(std::span<const Vector> x) const override {
    return (x[0].x * x[0].x + Real(3) * x[0].y * x[0].y + x[0].x * x[0].y) / Real(2);
  }

 private:
  void compute(std::span<const Vector> x, std::span<Vector> a) const override {
    const Real half = Real(1) / Real(2);
    a[0] = {-(x[0].x + half * x[0].y), -(Real(3) * x[0].y + half * x[0].x)};
  }
};

/// Particles of mass 1 that repel each other by 1/r, in the well V = r^2/2.
template <class Real>
class CoulombParticles final : public Problem<Real> {
 public:
  using typename Problem<Real>::Vector;
  /// Three particles; `frequency` is the omega of the first, the others' are -1/2 and 0 times it.
  explicit CoulombParticles(const char* frequency) {
    this->name = "three Coulomb particles";
    const Real w = decimal<Real>(frequency);
    this->omega = {w, -w / Real(2), Real(0)};
    this->start.position = {{decimal<Real>("1.0"), decimal<Real>("0.1")},
                            {decimal<Real>("-0.6"), decimal<Real>("0.8")},
                            {decimal<Real>("-0.4"), decimal<Real>("-0.9")}};
    this->start.velocity = {{decimal<Real>("0.3"), decimal<Real>("0.5")},
                            {decimal<Real>("-0.4"), decimal<Real>("0.2")},
                            {decimal<Real>("0.6"), decimal<Real>("-0.1")}};
  }
  Real potential(std::span<const Vector> x) const override {
    using std::sqrt;
    Real sum(0);
    for (std::size_t i = 0; i < x.size(); ++i) {
      sum = sum + dot(x[i], x[i]) / Real(2);
      for (std::size_t j = i + 1; j < x.size(); ++j)
        sum = sum + Real(1) / sqrt(dot(x[i] - x[j], x[i] - x[j]));
    }
    return sum;
  }

 private:
  void compute(std::span<const Vector> x, std::span<Vector> a) const override {
    using std::sqrt;
    for (std::size_t i = 0; i < x.size(); ++i) a[i] = -x[i];
    for (std::size_t i = 0; i < x.size(); ++i) {
      for (std::size_t j = i + 1; j < x.size(); ++j) {
        const Vector d = x[i] - x[j];
        const Real square = dot(d, d);
        const Vector force = (Real(1) / (square * sqrt(square))) * d;
        a[i] = a[i] + force;
        a[j] = a[j] - force;
      }
    }
  }
};

}  // namespace carom::problems
