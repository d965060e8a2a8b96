#include "integrators/energy_check.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace carom::integrators {
namespace {

using geometry::Vector;

/// Measured, not proved: against the bound without margin good steps change the energy by 0.25 at
/// most with Runge–Kutta and by 1 with Adams, in edges that are steep for the step by 10
/// (docs/physics/integrators.md).
constexpr double margin = 50.0;

/// Far more than the displacements that noise_at() tries.
bool is_short(double duration, const OdeProblem::Scale& scale) {
  return duration < 0x1p-16 * scale.time();
}

}  // namespace

double EnergyCheck::at(const Phase<double>& phase) const {
  const std::span<const double> mass = law_.masses();
  if (mass.empty()) return 0.0;
  double sum = law_.potential_energy(phase.position);
  for (std::size_t i = 0; i < mass.size(); ++i)
    sum += 0.5 * mass[i] * dot(phase.velocity[i], phase.velocity[i]);
  return sum;
}

void EnergyCheck::begin() {
  noise_ = 0.0;
  first_ = true;
}

bool EnergyCheck::allows(const End& from, const End& to, const OdeProblem::Scale& scale,
                         double duration) {
  const double change = excess(from, to, scale);
  const bool was_first = std::exchange(first_, false);
  if (change <= noise_) return true;
  // Rounding of the potential energy is no error of the step. Close to a jump it could not be
  // distinguished from that: there steps have become short.
  if (was_first || !is_short(duration, scale))
    noise_ = std::max(noise_, noise(from, to, scale.position));
  return change <= noise_;
}

bool EnergyCheck::allows_part(const End& from, const End& to, const OdeProblem::Scale& scale,
                              double duration) const {
  if (is_short(duration, scale)) return true;
  const double change = excess(from, to, scale);
  return change <= noise_ || change <= noise(from, to, scale.position);
}

/// By how much the energy changes more than the tolerance allows.
// The estimated error of an accepted step is e in root mean square over the 4n numbers of the
// state: with X and V the scales of positions and velocities, |dx| <= sqrt(4n) e X and |dv| <=
// sqrt(4n) e V over all particles. It changes the energy by sum m v.dv - m a.dx, and |m v| <=
// sqrt(2) V |m|.
double EnergyCheck::excess(const End& from, const End& to, const OdeProblem::Scale& scale) const {
  const std::span<const double> mass = law_.masses();
  if (mass.empty()) return 0.0;
  const double error = margin * tolerance_ * std::sqrt(4.0 * static_cast<double>(mass.size()));
  double square = 0.0;
  for (const double m : mass) square += m * m;
  const double change = std::fabs(to.energy - from.energy) - law_.energy_jumps() -
                        error * std::sqrt(2.0 * square) * scale.velocity * scale.velocity;
  if (change <= 0.0) return change;
  std::vector<Vector> acceleration(mass.size());
  law_.accelerations(to.phase.position, acceleration);
  square = 0.0;
  for (std::size_t i = 0; i < mass.size(); ++i)
    square += mass[i] * mass[i] * dot(acceleration[i], acceleration[i]);
  return change - error * std::sqrt(square) * scale.position;
}

/// What rounding does to the potential energy on the way. Of three places one may be at a jump:
/// that is no rounding.
double EnergyCheck::noise(const End& from, const End& to, double size) const {
  std::vector<Vector> middle = from.phase.position;
  for (std::size_t i = 0; i < middle.size(); ++i)
    middle[i] = 0.5 * (middle[i] + to.phase.position[i]);
  const double a = noise_at(from.phase.position, size), b = noise_at(middle, size),
               c = noise_at(to.phase.position, size);
  const double of_value = 0x1p-51 * std::max(std::fabs(from.energy), std::fabs(to.energy));
  return of_value + 2.0 * std::max(std::min(a, b), std::min(std::max(a, b), c));
}

/// By how much fourth differences of the potential energy are off, over displacements too small for
/// its derivatives.
double EnergyCheck::noise_at(const std::vector<Vector>& position, double size) const {
  double most = 0.0;
  for (const double part : {0x1p-51, 0x1p-44, 0x1p-37, 0x1p-30, 0x1p-23}) {
    double sum = 0.0;
    for (const auto& [steps, weight] :
         {std::pair{-2.0, 1.0}, {-1.0, -4.0}, {0.0, 6.0}, {1.0, -4.0}, {2.0, 1.0}}) {
      std::vector<Vector> moved = position;
      double sign = steps * part * size;
      for (Vector& x : moved) {  // neighbours go opposite ways, so that pairs are seen
        x = x + sign * Vector{1.0, 0.625};
        sign = -sign;
      }
      sum += weight * law_.potential_energy(moved);
    }
    most = std::max(most, std::fabs(sum));
  }
  return most;
}

}  // namespace carom::integrators
