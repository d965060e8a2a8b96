#include "ensemble/compare/precise_orbit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string_view>

#include "carom/integrators/arithmetic.hpp"
#include "carom/integrators/scheme.hpp"
#include "forces/quad_forces.hpp"
#include "integrators/splitting.hpp"

namespace carom {

using forces::Quad;

template <>
struct Arithmetic<Quad> {
  static Quad parse(std::string_view decimal) { return Quad::parse(decimal); }
  static SineCosine<Quad> turn(const Quad& angle) {
    const auto [sine, cosine] = sine_and_cosine(angle);
    return {sine, cosine};
  }
};

namespace ensemble {

namespace {

using Vector = geometry::BasicVector<Quad>;

/// Terms of forces that all orbits together may cost: some seconds.
constexpr double most_terms = 1.5e6;
/// Errors below it are as good as none beside the rounding of a double.
constexpr double wanted_error = 1e-17;
/// Steps between two times that are compared, of sixteen in all.
constexpr int parts = looks / looks_between_states;

class Law final : public ForceLaw<Quad> {
 public:
  explicit Law(const Runs& runs)
      : runs_(runs),
        forces_(runs.system().dynamics.forces->spec(), runs.system().particles,
                runs.system().table->lattice) {}
  void accelerations(std::span<const Vector> position,
                     std::span<Vector> acceleration) const override {
    runs_.stop_if_asked();
    forces_.accelerations(position, acceleration);
  }
  /// Terms of the forces there.
  double terms_at_start() const {
    std::vector<Vector> position, acceleration(runs_.starts().size());
    for (const State& start : runs_.starts())
      position.push_back({start.position.x, start.position.y});
    return forces_.accelerations(position, acceleration);
  }

 private:
  const Runs& runs_;
  forces::QuadForces forces_;
};

using Path = std::vector<Phase<Quad>>;  // at the times that are compared

Path follow(const Runs& runs, const Law& law, const Scheme& scheme, double t, int steps_a_part) {
  Phase<Quad> now, next;
  std::vector<Quad> omega;
  const System& system = runs.system();
  for (const State& start : runs.starts()) {
    const PlaneState plane = in_the_plane(*system.table, start);
    now.position.push_back({plane.position.x, plane.position.y});
    now.velocity.push_back({plane.velocity.x, plane.velocity.y});
  }
  for (const Particle& p : system.particles) omega.emplace_back(p.omega);
  integrators::SplittingStepper<Quad> stepper(scheme, law, omega);
  const Quad step = Quad(t) / Quad(static_cast<double>(parts) * steps_a_part);
  Path path;
  for (int part = 1; part <= parts; ++part) {
    for (int k = 0; k < steps_a_part; ++k) {
      stepper.step(now, step, next);
      std::swap(now, next);
    }
    if (part > parts - states_compared) path.push_back(now);
  }
  return path;
}

double distance(const Path& a, const Path& b, const ErrorUnits& units) {
  StateDistance most;
  const auto apart = [](const Vector& one, const Vector& other) {
    const Vector d = one - other;
    return root(dot(d, d)).to_double();
  };
  for (std::size_t k = 0; k < a.size(); ++k)
    for (std::size_t i = 0; i < a[k].position.size(); ++i) {
      most.position = larger(most.position, apart(a[k].position[i], b[k].position[i]));
      most.velocity = larger(most.velocity, apart(a[k].velocity[i], b[k].velocity[i]));
    }
  return most.in(units);
}

geometry::Vector rounded(const Vector& a) { return {a.x.to_double(), a.y.to_double()}; }

PreciseOrbit rounded(const Path& path, double step, double error, const ErrorUnits& units) {
  PreciseOrbit orbit{{}, step, error};
  StateDistance largest;
  for (const Phase<Quad>& phase : path) {
    std::vector<PlaneState>& states = orbit.states.emplace_back();
    for (std::size_t i = 0; i < phase.position.size(); ++i) {
      states.push_back({rounded(phase.position[i]), rounded(phase.velocity[i])});
      largest.position = larger(largest.position, length(states.back().position));
      largest.velocity = larger(largest.velocity, length(states.back().velocity));
    }
  }
  orbit.error += 0x1p-53 * largest.in(units);
  return orbit;
}

}  // namespace

std::optional<PreciseOrbit> precise_orbit(const Runs& runs, const std::string& name, double step,
                                          double t, const ErrorUnits& units) {
  const Scheme& scheme = find_scheme(name);
  const Law law(runs);
  // Terms of a step in each part.
  const double stages = static_cast<double>(integrators::stages_of<double>(scheme).size()) / 2.0;
  const double cost = parts * stages * law.terms_at_start();
  // Each halving divides the error by 2^order; by half as much at least, or it is not yet the
  // order that counts.
  const double least = std::ldexp(0.5, scheme.order);
  std::optional<PreciseOrbit> best;
  int falling = 0;  // halvings one after the other that did
  Path path;
  double change = std::numeric_limits<double>::quiet_NaN(), spent = 0.0;
  for (int steps = std::max(1, static_cast<int>(std::ceil(t / (step * parts))));; steps *= 2) {
    spent += cost * steps;
    if (spent > most_terms) return best;
    Path finer = follow(runs, law, scheme, t, steps);
    if (!path.empty()) {
      const double before = change;
      change = distance(path, finer, units);
      falling = before > least * change ? falling + 1 : 0;
      // An orbit that a finer one leaves by more than its error was good by chance.
      if (best && change > best->error) best.reset();
      if (falling > 1) {
        const double error = change / (least - 1.0);
        best = rounded(finer, t / (static_cast<double>(parts) * steps), error, units);
        if (error < wanted_error) return best;
      }
    }
    path = std::move(finer);
  }
}

}  // namespace ensemble
}  // namespace carom
