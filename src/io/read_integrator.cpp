// [integrator].
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "carom/integrators/scheme.hpp"
#include "io/read.hpp"

namespace carom::io {
namespace {

/// Within which length a bump's force rises and falls: a Fermi function's does within a few softnesses of its edge.
double scale_of(const PotentialSpec& potential) {
  using Kind = PotentialSpec::Kind;
  if (potential.kind == Kind::gaussian) return potential.width;
  if (potential.kind == Kind::fermi) return 8.0 * potential.softness;
  return std::numeric_limits<double>::infinity();
}

}  // namespace

void limit_step(Value& root, IntegratorPlan& plan, const ForceSpec& forces, const std::vector<Particle>& particles,
                const std::vector<double>& energies) {
  if (!is_adaptive(plan.scheme) || plan.step > 0.0) return;
  double scale = std::numeric_limits<double>::infinity(), depth = 0.0;
  for (const PotentialSpec& potential : forces.potentials) {
    scale = std::min(scale, scale_of(potential));
    if (std::isfinite(scale_of(potential))) depth += std::max(-potential.height, 0.0);
  }
  double fastest = 0.0;
  for (std::size_t k = 0; k < particles.size(); ++k) {
    const Particle& p = particles[k];
    double square = p.speed * p.speed;
    if (k < energies.size()) square = std::max(square, 2.0 * energies[k] / p.mass);
    fastest = std::max(fastest, std::sqrt(square + 2.0 * depth / p.mass));
  }
  if (!std::isfinite(scale) || !(fastest > 0.0)) return;
  plan.step = scale / fastest;
  Section section(*root.find("integrator"), "integrator");
  section.fill("step", number_value(fmt::format("{}", plan.step), section.place_of("step")));
}

IntegratorPlan read_integrator(Value& root, bool forces, const std::vector<Particle>& particles, bool walls) {
  IntegratorPlan plan;
  Value* value = root.find("integrator");
  if (value == nullptr) {
    if (forces) check_plan(plan, {root.place.file, 0, 0, "integrator"});  // says what is missing
    return plan;
  }
  Section section(*value, "integrator");
  section.check_keys();
  const Value& scheme = section.get("scheme");
  plan.scheme = as_text(scheme);
  if (!is_adaptive(plan.scheme)) find_scheme(plan.scheme, scheme.place);
  Place place = value->place;
  if (const Value* step = section.find("step")) {
    plan.step = as_positive(*step);
    place = step->place;
  }
  if (const Value* tolerance = section.find("tolerance")) {
    plan.tolerance = as_positive(*tolerance);
    place = tolerance->place;
  } else if (is_adaptive(plan.scheme)) {
    plan.tolerance = default_tolerance;
    section.fill("tolerance", number_value("1e-12", section.place_of("tolerance")));
  }
  plan.energy_tolerance = as_positive(section.get("energy_tolerance"));
  const Value& unresolved = section.get("unresolved");
  plan.count_unresolved = as_text(unresolved) == "count";
  if (!plan.count_unresolved && as_text(unresolved) != "stop")
    throw InputError(unresolved.place, "unknown treatment of unresolved steps '" + unresolved.text + "'",
                     "\"stop\" or \"count\"", nearest_name(unresolved.text, {"stop", "count"}));
  const Value& treatment = section.get("walls");
  plan.split_walls = as_text(treatment) == "split";
  if (!plan.split_walls && as_text(treatment) != "reflect")
    throw InputError(treatment.place, "unknown treatment of walls '" + treatment.text + "'",
                     "\"reflect\" or \"split\"");
  Place split_place = treatment.place;
  split_place.key = "integrator";
  check_split_walls(plan, split_place);
  place.key = "integrator";  // the checks add the key at fault
  if (forces || plan.tolerance > 0.0) check_plan(plan, place);
  if (forces) {
    double largest = 0.0;
    for (const Particle& p : particles) largest = std::max(largest, std::fabs(p.omega));
    check_turn(plan, largest, walls, place);
  }
  return plan;
}

}  // namespace carom::io
