#include "integrators/energy_check.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace carom {
namespace {

using geometry::Vector;

/// Against the bound without margin good steps change the energy by 0.25 at most with Runge–Kutta and by 1 with Adams,
/// in edges that are steep for the step by 10 (docs/physics/integrators.md).
constexpr double margin = 50.0;

}  // namespace

double EnergyCheck::at(const Phase<double>& phase) const {
  const std::span<const double> mass = law_.masses();
  if (mass.empty()) return 0.0;
  double sum = law_.potential_energy(phase.position);
  for (std::size_t i = 0; i < mass.size(); ++i) sum += 0.5 * mass[i] * dot(phase.velocity[i], phase.velocity[i]);
  return sum;
}

void EnergyCheck::begin() {
  noise_ = 0.0;
  first_ = true;
}

// The estimated error of an accepted step is e in root mean square over the 4n numbers of the state: with X and V the
// scales of positions and velocities, |dx| <= sqrt(4n) e X and |dv| <= sqrt(4n) e V over all particles. It changes the
// energy by sum m v.dv - m a.dx, and |m v| <= sqrt(2) V |m|.
bool EnergyCheck::allows(const End& from, const End& to, std::span<const Vector> acceleration,
                         const OdeProblem::Scale& scale, double duration) {
  const std::span<const double> mass = law_.masses();
  if (mass.empty()) return true;
  double mass_square = 0.0, force_square = 0.0;
  for (std::size_t i = 0; i < mass.size(); ++i) {
    mass_square += mass[i] * mass[i];
    force_square += mass[i] * mass[i] * dot(acceleration[i], acceleration[i]);
  }
  const double error = tolerance_ * std::sqrt(4.0 * static_cast<double>(mass.size()));
  const double allowed = margin * error *
                             (std::sqrt(2.0 * mass_square) * scale.velocity * scale.velocity +
                              std::sqrt(force_square) * scale.position) +
                         law_.energy_jumps();
  const double change = std::fabs(to.energy - from.energy);
  const bool was_first = std::exchange(first_, false);
  if (change <= allowed + noise_) return true;
  // Rounding of the potential energy is no error of the step. Close to a jump it could not be told from it: there steps
  // have become short.
  if (was_first || !scale.is_short(duration))
    noise_ = std::max({noise_, noise(from.phase, scale.position), noise(to.phase, scale.position)});
  return change <= allowed + noise_;
}

/// By how much second differences over a few units in the last place are off.
double EnergyCheck::noise(const Phase<double>& at, double size) {
  const double middle = law_.potential_energy(at.position);
  double most = 0.0;
  for (int k = 1; k <= 4; ++k) {
    double sum = -2.0 * middle;
    for (const double side : {-0x1p-51, 0x1p-51}) {
      moved_ = at.position;
      double sign = 1.0;
      for (Vector& x : moved_) {  // neighbours go opposite ways, so that pairs are seen
        x = x + (sign * side * size) * Vector{static_cast<double>(k), static_cast<double>(5 - k)};
        sign = -sign;
      }
      sum += law_.potential_energy(moved_);
    }
    most = std::max(most, std::fabs(sum));
  }
  return 4.0 * most;
}

}  // namespace carom
