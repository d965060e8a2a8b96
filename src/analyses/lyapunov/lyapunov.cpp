#include "carom/analyses/lyapunov.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "analyses/lyapunov/lyapunov_listener.hpp"
#include "base/counted.hpp"
#include "carom/base/stopwatch.hpp"
#include "carom/geometry/curve_frame.hpp"
#include "carom/starts/injection.hpp"
#include "carom/starts/sampler.hpp"
#include "carom/starts/start_measure.hpp"
#include "engines/followed_deviations.hpp"

namespace carom {

using namespace analyses;
using engines::refuse_no_deviations;
using engines::unit_length_of;

namespace {

GrowthSums plan_of(const System& system) {
  return {growth_window(system),
          system.run.trajectories * (interacts(system) ? 1 : system.particles.size()),
          system.quasi_random()};
}

// The looks, which cost no more. Of few orbits twice as many, and down to a mean flight: but under
// forces steps end at each time, and a picture must not change them.
std::vector<double> times_of_convergence(const System& system, const GrowthSums& plan) {
  constexpr double half_octave = 0.7071067811865476;
  std::vector<double> times;
  for (std::size_t look = 0; look < GrowthSums::looks; ++look)
    times.push_back(plan.look_time(look));
  if (plan.blocks() == 1 || system.is_integrated()) return times;
  const double unit = unit_length_of(*system.table) / system.particles.front().speed;
  for (std::size_t look = GrowthSums::looks; look-- > 1;)
    times.push_back(half_octave * times[look]);
  for (double t = times.front(); t >= unit && times.size() + 2 <= ConvergenceSums::most; t *= 0.5) {
    times.push_back(half_octave * t);
    times.push_back(0.5 * t);
  }
  std::sort(times.begin(), times.end());
  return times;
}

void refuse_no_exponents(const System& system) {
  refuse_no_deviations(system);
  if (system.run.spectrum) refuse_quasi_random(system, "a spectrum");
  if (system.run.spectrum && system.particles.size() > 1 && !act_on_each_other(system))
    throw InputError(Place{"", 0, 0, "run.spectrum"},
                     "the particles do not interact: each has a separate spectrum",
                     "an interaction, or one particle");
  if (system.run.spectrum && system.particles.size() > most_particles_of_spectrum)
    throw InputError(
        Place{"", 0, 0, "run.spectrum"},
        fmt::format("{} particles have {} exponents, and the work grows as the cube of that",
                    system.particles.size(), 4 * system.particles.size()),
        fmt::format("{} particles at most, or the largest exponent alone",
                    most_particles_of_spectrum));
  const TimeWindow window = growth_window(system);
  if (!(window.from >= 0.0 && window.from < window.to && window.to <= system.run.t_max))
    throw InputError(Place{"", 0, 0, "run.window"}, "deviations grow during the run",
                     "0 <= from < to <= run.t_max");
}

// Are walls and potentials the same in all directions about one point?
bool is_round(const Table& table, const ForceField& forces) {
  if (table.lattice || !forces.isotropic()) return false;
  std::optional<geometry::Vector> middle = forces.middle();
  for (const Wall& wall : table.walls) {
    const geometry::CurveFrame frame = geometry::frame_of(wall.curve);
    if (!frame.circular || (middle && !(*middle == frame.middle))) return false;
    middle = frame.middle;
  }
  return true;
}

}  // namespace

bool interacts(const System& system) { return system.run.spectrum || act_on_each_other(system); }

VanishingExponents vanishing_exponents(const System& system) {
  const std::vector<Particle>& particles = system.particles;
  const ForceField none, &forces = system.dynamics.forces ? *system.dynamics.forces : none;
  VanishingExponents v;
  v.count = 2;
  v.laws.push_back("energy");
  const bool alike = std::all_of(particles.begin(), particles.end(), [&](const Particle& p) {
    return p.omega == particles.front().omega;
  });
  if (system.table->walls.empty() && forces.harmonic() && alike) {
    v.count += 4;
    v.laws.push_back(forces.external() ? "motion of the centre of mass" : "momentum");
  }
  if (is_round(*system.table, forces)) {
    v.count += 2;
    v.laws.push_back("angular momentum");
  }
  v.count = std::min(v.count, 4 * particles.size());
  return v;
}

std::vector<ExponentAt> convergence_of(const LyapunovResult& result) {
  return result.convergence.exponents(result.growth.totals().orbits, result.growth.parts().empty());
}

std::string why_all_are_regular(const System& system) {
  if (act_on_each_other(system)) return {};
  const std::vector<Wall>& walls = system.table->walls;
  const ForceField none, &forces = system.dynamics.forces ? *system.dynamics.forces : none;
  const bool free = forces.empty(),
             straight_flights =
                 free && std::all_of(system.particles.begin(), system.particles.end(),
                                     [](const Particle&p) { return p.omega == 0.0; });
  const auto is_straight = [](const Wall& wall) {
    return std::holds_alternative<geometry::Segment>(wall.curve);
  };
  if (straight_flights && !walls.empty() && std::all_of(walls.begin(), walls.end(), is_straight))
    return "all walls are straight";
  if (straight_flights && walls.size() == 1 && !system.table->lattice &&
      std::holds_alternative<geometry::Ellipse>(walls.front().curve))
    return "energy and the product of the angular momenta about the foci are conserved";
  if ((!walls.empty() || !free) && is_round(*system.table, forces))
    return "energy and angular momentum are conserved";
  return {};
}

LyapunovEstimate estimate_of(const System& system, const LyapunovResult& result) {
  // A start that is chosen may lie on an unstable orbit.
  using Kind = InitialCondition::Kind;
  const Kind kind = system.initial.kind;
  const bool chosen =
      kind == Kind::point || kind == Kind::list || kind == Kind::line || kind == Kind::birkhoff;
  LyapunovEstimate e =
      estimate_of(result.growth, !why_all_are_regular(system).empty() &&
                                     (!chosen || result.growth.totals().chaotic == 0));
  if (!system.run.spectrum) return e;
  // The exponent is the first of the spectrum, whose report tells linear growth.
  const LyapunovEstimate means = mean_growth_of(result.growth);
  e.law = LyapunovEstimate::Law::exponential;
  e.per_time = means.per_time, e.per_hit = means.per_hit;
  e.would_show = e.regular_bias = 0.0;
  return e;
}

bool LyapunovResult::add(const LyapunovResult& other) {
  if (!add_common(other)) return false;
  repeller.reset();  // it is the whole ensemble's
  no_repeller.reset();
  growth.merge(other.growth);
  convergence.merge(other.convergence);
  spectrum.merge(other.spectrum);
  drift.merge(other.drift);
  entropy_drift.merge(other.entropy_drift);
  add_ends(other);
  return true;
}

std::size_t growing_exponents(const System& system) {
  if (!system.run.spectrum) return 0;
  return (4 * system.particles.size() - vanishing_exponents(system).count) / 2;
}

TimeWindow growth_window(const System& system) {
  if (const auto& window = system.run.window) return {window->first, window->second};
  // Deviations have then turned into the direction that grows.
  return {0.2 * system.run.t_max, system.run.t_max};
}

void add_repeller(const System& system, LyapunovResult& result, const SplittingOptions& how) {
  const bool whole = result.complete && result.done.size() == system.run.trajectories;
  const std::uint64_t stay = result.growth.totals().orbits;
  if (!whole || system.run.spectrum || !is_open(system) || 2 * stay >= result.trajectories) return;
  const Stopwatch watch;
  try {
    // Populations are drawn at random, from the same distribution.
    System random = system;
    if (random.quasi_random()) random.initial.kind = InitialCondition::Kind::uniform;
    result.repeller =
        measure_repeller(random, growth_window(system), unit_length_of(*system.table), how);
    if (!result.repeller) result.complete = false;
  } catch (const InputError& error) {
    result.no_repeller = error;
  }
  result.seconds += watch.seconds();
  result.cpu_seconds += watch.cpu_seconds();
}

std::optional<InputError> why_nothing(const System& system, const LyapunovResult& result) {
  if (!result.complete || result.done.size() != system.run.trajectories || result.repeller ||
      result.lost + result.unresolved > 0)
    return std::nullopt;
  if (result.growth.totals().orbits > 0) {
    // Those that stay are then not those that never leave, and their error would be of no use; of a
    // few trajectories they are what was asked for.
    if (!result.no_repeller || result.trajectories < least_of_repeller()) return std::nullopt;
    return result.no_repeller;
  }
  const std::string ended =
      fmt::format("all {} ended before t = {:.6g}, the end of the window",
                  base::counted(result.trajectories, "particle"), result.growth.window().to);
  if (const auto& error = result.no_repeller)
    return InputError(error->place(), ended + ", and " + error->problem(), error->expected());
  if (result.capped > 0)
    return InputError(Place{"", 0, 0, "run.collisions"},
                      fmt::format("{}: {} of them after {}", ended, base::grouped(result.capped),
                                  base::counted(system.run.collisions, "collision")),
                      "more --collisions, or a window (--window) that some of them outlive");
  return InputError(Place{"", 0, 0, "run.t_max"}, ended,
                    "a run (--t-max) or a window (--window) that some of them outlive");
}

LyapunovResult run_lyapunov(const System& system, const LyapunovOptions& options) {
  refuse_no_exponents(system);
  LyapunovResult nothing;
  nothing.growth = plan_of(system);
  if (system.run.spectrum)
    nothing.spectrum = {nothing.growth, 4 * system.particles.size(),
                        vanishing_exponents(system).count};
  const double unit_length = unit_length_of(*system.table);
  nothing.convergence = ConvergenceSums(times_of_convergence(system, nothing.growth));
  const GrowthTimes times(nothing.growth, nothing.convergence);
  LyapunovResult result = engines::fly_blocks<LyapunovResult>(
      system, with_starts_of_the_flow(system), options, nothing,
      {.t_end = nothing.growth.window().to,
       .deviations = times.times(),
       .unit_length = unit_length,
       .frame = system.run.spectrum},
      [&](const Engine& engine, LyapunovListener::Thread& thread) {
        return LyapunovListener(system, times, nothing.growth, unit_length, engine, thread);
      });
  SplittingOptions how;
  how.threads = options.threads;
  how.decisions = options.decisions;
  how.lanes = options.lanes;
  how.interrupted = options.interrupted;
  add_repeller(system, result, how);
  return result;
}

}  // namespace carom
