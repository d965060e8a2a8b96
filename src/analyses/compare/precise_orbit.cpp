#include "analyses/compare/precise_orbit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analyses/compare/precise_path.hpp"

namespace carom::analyses {

namespace {

/// Terms of forces that all orbits together may cost: some seconds.
constexpr double most_terms = 1.5e6;
/// Errors below it are as good as none beside the rounding of a double.
constexpr double wanted_error = 1e-17;
/// The first steps are longer than those in doubles by 2 to this power. Where those of the same
/// length and longer ones do not hit the walls that are expected, shorter ones will not, either.
constexpr int halvings_to_doubles = 3;
/// Changes that are none: far above the rounding of 34 digits and all that they grow by.
constexpr double no_change = 1e-24;

double length(const QuadVector& a) { return root(dot(a, a)).to_double(); }

double distance(const PrecisePath& a, const PrecisePath& b, const ErrorUnits& units) {
  StateDistance most;
  for (std::size_t k = 0; k < a.states.size(); ++k)
    for (std::size_t i = 0; i < a.states[k].position.size(); ++i) {
      most.position =
          larger(most.position, length(a.states[k].position[i] - b.states[k].position[i]));
      most.velocity =
          larger(most.velocity, length(a.states[k].velocity[i] - b.states[k].velocity[i]));
    }
  return most.in(units);
}

PreciseOrbit in_doubles(const PrecisePath& path, double step, double error,
                        const ErrorUnits& units) {
  PreciseOrbit orbit{{}, {}, step, error};
  StateDistance largest;
  for (const Phase<Quad>& phase : path.states) {
    std::vector<PlaneState>& states = orbit.states.emplace_back();
    for (std::size_t i = 0; i < phase.position.size(); ++i) {
      states.push_back({rounded(phase.position[i]), rounded(phase.velocity[i])});
      largest.position = larger(largest.position, geometry::length(states.back().position));
      largest.velocity = larger(largest.velocity, geometry::length(states.back().velocity));
    }
  }
  orbit.error += 0x1p-53 * largest.in(units);
  for (const PreciseHit& hit : path.hits)
    orbit.hits.push_back(
        {{hit.particle, hit.wall, hit.t.to_double(), rounded(hit.place)}, hit.speed, hit.across});
  return orbit;
}

}  // namespace

std::optional<PreciseOrbit> precise_orbit(const Runs& runs, const std::string& name,
                                          double step_in_doubles, double t, const ErrorUnits& units,
                                          std::span<const ComparedHit> expected) {
  const Scheme& scheme = find_scheme(name);
  PreciseMotion motion(runs, scheme);
  const PrecisePlace start = motion.start();
  // Each halving divides the error by 2^order; by half as much at least, or it is not yet the
  // order that counts.
  const double least = std::ldexp(0.5, scheme.order);
  std::optional<PreciseOrbit> best;
  int falling = 0;  // halvings one after the other that did
  int misses = 0;
  const double first_step = std::ldexp(step_in_doubles, halvings_to_doubles);
  std::optional<PrecisePath> path;
  double change = std::numeric_limits<double>::quiet_NaN(), last_terms = 0.0;
  for (int steps = std::max(1, static_cast<int>(std::ceil(t / (first_step * parts))));;
       steps *= 2) {
    // Twice the steps cost twice as much, nearly.
    const double spent = motion.terms();
    if (spent + 2.0 * last_terms > most_terms) return best;
    std::optional<PrecisePath> finer = motion.follow(start, Quad(t), steps, expected, most_terms);
    if (motion.terms() > most_terms && !finer) return best;
    last_terms = motion.terms() - spent;
    if (path && finer) {
      const double before = change;
      change = distance(*path, *finer, units);
      falling =
          before > least * change || (before < no_change && change < no_change) ? falling + 1 : 0;
      // An orbit that a finer one leaves by more than its error was good by chance.
      if (best && change > best->error) best.reset();
      if (falling > 1) {
        const double error = change / (least - 1.0);
        best = in_doubles(*finer, t / (static_cast<double>(parts) * steps), error, units);
        if (error < wanted_error) return best;
      }
    } else {
      change = std::numeric_limits<double>::quiet_NaN();
      falling = 0;
      best.reset();
      if (!finer && ++misses > halvings_to_doubles) return {};
    }
    path = std::move(finer);
  }
}

bool same_hits(const std::vector<ComparedHit>& hits, const std::vector<PreciselyHit>& precise,
               double error) {
  if (hits.size() != precise.size()) return false;
  for (std::size_t k = 0; k < hits.size(); ++k) {
    const ComparedHit &a = hits[k], &b = precise[k].seen;
    const double late = error / precise[k].across + rounding_of_flight * b.t,
                 beside = error + precise[k].speed * late +
                          rounding_of_flight * geometry::length(b.place);
    if (!(std::fabs(a.t - b.t) <= late && geometry::length(a.place - b.place) <= beside))
      return false;
  }
  return true;
}

}  // namespace carom::analyses
