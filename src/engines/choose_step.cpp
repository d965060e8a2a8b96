#include "carom/engines/choose_step.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "base/interrupt.hpp"
#include "carom/events/energy.hpp"
#include "carom/events/report.hpp"
#include "carom/events/world.hpp"
#include "carom/geometry/hull.hpp"
#include "carom/integrators/scheme.hpp"
#include "carom/starts/sampler.hpp"
#include "forces/resolution.hpp"

namespace carom {

using geometry::Vector;

namespace {

constexpr double wanted_energy_error = 1e-10;
constexpr int most_trials = 16, steps_of_a_trial = 100, looks = 10;
/// Of a particle in a trial run, which ends there: forces that press a particle against a wall make
/// it hit without end, and so do walls much nearer to each other than a step is long.
constexpr int most_hits = 1000;
/// Particles that fly in a trial run if they do not interact.
constexpr std::size_t most_alone = 100;
/// Evaluations of pair forces that all trial runs of one step may cost.
constexpr double affordable = 2e7;
/// Evaluations of forces of all steps that are tried, after which none shorter is: some seconds.
constexpr std::uint64_t most_evaluations = 5'000'000;
/// Meshes of forces that are bounded for all steps together; no step needs as many, but a force of
/// thousands of narrow parts may.
constexpr int most_meshes = 50000;
/// The shortest step that is tried, against the longest that is resolved at the start, and against
/// the longest that is resolved all along.
constexpr double shortest_resolved = 1e-3, shortest = 1e-2;

/// 1, 2, 5, 10, ...: number 3 k is 10^k, exactly as it is read from a file.
double step_number(int n) {
  const int k = n >= 0 ? n / 3 : -((2 - n) / 3);
  static constexpr const char* digits[] = {"1", "2", "5"};
  return std::stod(std::string(digits[n - 3 * k]) + "e" + std::to_string(k));
}

class TrialRuns {
 public:
  TrialRuns(const System& system, const std::function<bool()>& stopped)
      : system_(system), stopped_(stopped), sampler_(system_, stopped) {
    const std::size_t all = system.particles.size();
    if (!system.dynamics.forces->interacts()) stride_ = (all - 1) / most_alone + 1;
    const double n = static_cast<double>((all - 1) / stride_ + 1);
    const double each = 11.0 * n * std::max(1.0, 0.5 * (n - 1.0));
    count_ =
        std::clamp(static_cast<int>(affordable / (each * 10.0 * steps_of_a_trial)), 1, most_trials);
    length_ =
        std::clamp(static_cast<int>(affordable / (each * 10.0 * count_)), 10, steps_of_a_trial);
  }

  /// The largest error of the energy within many steps of h0, with steps of h; nothing where a step
  /// is not resolved.
  std::optional<double> energy_error(double h, double h0) { return follow(h, length_ * h0); }
  /// Are steps of h resolved until a time?
  bool resolve(double h, double until) { return follow(h, until).has_value(); }
  double highest_energy() const { return energy_; }
  std::uint64_t evaluations() const { return evaluations_; }
  const std::string& report() const { return report_; }

 private:
  std::optional<double> follow(double h, double until) {
    system_.dynamics.integrator.step = h;
    system_.dynamics.integrator.halve_unresolved = false;
    World world(*system_.table, system_.dynamics);
    Observer observer;
    double worst = 0.0;
    for (int k = 0; k < count_; ++k) {
      world.clear();
      world.limit_hits(most_hits);
      const auto trajectory = static_cast<std::uint64_t>(k);
      if (starts_.size() == trajectory) starts_.push_back(sampler_.draw_all(world, trajectory));
      for (std::size_t p = 0; p < starts_[trajectory].size(); p += stride_)
        add_start(world, system_, starts_[trajectory][p], trajectory, static_cast<int>(p));
      const std::uint64_t before = world.step_counts().force_evaluations;
      const Energy start = energy(world, Time(0.0));
      if (k == 0) energy_ = start.total();
      energy_ = std::max(energy_, start.total());
      double kinetic = start.kinetic, change = 0.0;
      const double end = std::min(system_.run.t_max, until);
      for (int look = 1; look <= looks; ++look) {
        const double t = end * look / looks;
        world.run_until(t, observer, stopped_);
        if (stopped_ && stopped_()) throw SamplingStopped();
        bool all = true;
        for (int i = 0; i < world.size(); ++i) {
          if (world.fate(i) == Fate::unresolved || world.fate(i) == Fate::lost) {
            report_ = shown(world.report(i));
            return {};
          }
          all = all && !world.finished(i);
        }
        if (!all) break;
        const Energy now = energy(world, Time(t));
        kinetic = std::max(kinetic, now.kinetic);
        change = std::max(change, std::fabs(now.total() - start.total()));
      }
      evaluations_ += world.step_counts().force_evaluations - before;
      if (change > 0.0) worst = std::max(worst, change / kinetic);
    }
    return worst;
  }
  Energy energy(const World& world, Time t) const {
    std::vector<Particle> particles;
    std::vector<State> states;
    for (int i = 0; i < world.size(); ++i) {
      particles.push_back(world.particle(i));
      states.push_back(world.state_at(i, t));
    }
    base::Interrupt interrupt(&stopped_);
    const Energy sum = energy_of(particles, states, system_.dynamics, *system_.table, &interrupt);
    if (interrupt.stopped()) throw SamplingStopped();
    return sum;
  }

  System system_;
  std::function<bool()> stopped_;
  Sampler sampler_;
  std::vector<std::vector<State>> starts_;  ///< by trajectory: rare starts are slow to draw
  std::size_t stride_ = 1;  ///< between the particles that fly, of those that do not interact
  int count_ = 1, length_ = 1;
  double energy_ = 0.0;
  std::uint64_t evaluations_ = 0;
  std::string report_;
};

/// Does a step resolve the external forces wherever a particle of that energy can be? True where
/// that is not known beforehand: in the open plane, where particles interact, and where all
/// `meshes` are used up.
bool resolves_region(const System& system, const World& world, double energy, double h,
                     int& meshes) {
  const Table& table = *system.table;
  const ForceField& forces = *system.dynamics.forces;
  if (!forces.external() || system.particles.size() > 1 || table.extent == Extent::open_plane)
    return true;
  const geometry::Box box =
      table.lattice ? geometry::hull_of(table.lattice->edges,
                                        [](const auto& e) {
                                          return geometry::Box{e.segment.from, e.segment.from};
                                        })
                    : geometry::hull_of(table.walls, [](const Wall& wall) {
                        return geometry::bounding_box(wall.curve);
                      });
  forces::ForceMap map(forces, system.particles.front());
  const auto inside = [&](Vector x) { return table.lattice || world.contains(x); };
  return map.resolves_everywhere(box.low, box.high, energy, inside,
                                 forces::resolution::span_of(h / forces::resolution::steps_a_radius,
                                                             system.particles.front().omega),
                                 meshes) ||
         meshes <= 0;
}

}  // namespace

bool needs_step(const System& system) {
  return system.has_forces() && !is_adaptive(system.dynamics.integrator.scheme) &&
         !(system.dynamics.integrator.step > 0.0);
}

bool turn_allowed(const System& system, double step) {
  double omega = 0.0;
  for (const Particle& p : system.particles) omega = std::max(omega, std::fabs(p.omega));
  return omega * step <= (system.table->walls.empty() ? 2.0 : 1.0);
}

ChosenStep choose_step(const System& system, const std::function<bool()>& stopped) {
  TrialRuns trials(system, stopped);
  const World world(*system.table);
  const double longest = std::min(system.run.t_max, 1e15);
  int n = 0;
  while (step_number(n) < longest) ++n;
  while (step_number(n - 1) >= longest) --n;
  ChosenStep best{0.0, std::numeric_limits<double>::infinity()};
  double at_start = 0.0, resolved = 0.0;
  int meshes = most_meshes;
  constexpr int most_tried = 150;
  for (int tried = 0; tried < most_tried; ++tried, --n) {
    const double h = step_number(n);
    if (h > longest || !turn_allowed(system, h)) continue;
    if (!(at_start > 0.0)) {
      if (!trials.resolve(h, h) ||
          !resolves_region(system, world, trials.highest_energy(), h, meshes))
        continue;
      at_start = h;
    }
    if (h < shortest_resolved * at_start || h < shortest * resolved) break;
    const std::optional<double> error = trials.energy_error(h, at_start);
    if (!error) continue;
    if (!(resolved > 0.0)) resolved = h;
    if (*error < best.energy_error) best = {h, *error};
    if (*error <= wanted_energy_error || trials.evaluations() > most_evaluations) break;
  }
  if (!(best.step > 0.0))
    throw InputError(Place{{}, 0, 0, "integrator.step"},
                     "no step resolves the forces: " + trials.report(),
                     "a softer potential, or a step that you choose");
  return best;
}

}  // namespace carom
