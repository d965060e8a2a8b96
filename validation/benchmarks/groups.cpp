// CPU time of a step of charges among hard walls, hits included, beside the evaluations of all
// forces that its pieces need: those of one step of the scheme a step, and a hit. The energy must
// be what the scheme promises.
#include <fmt/format.h>

#include <carom/carom.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "carom/events/energy.hpp"
#include "measuring.hpp"
#include "table.hpp"

namespace carom::bench {

namespace {

struct Row {
  const char* name;
  int particles;
  const char* step;  ///< one that resolves the forces
  int steps;
  double energy;  ///< most that it may change, relatively
};
constexpr Row rows[] = {{"coulomb-circle, 15 charges", 15, "0.001", 1000, 1e-12},
                        {"coulomb-circle, 100 charges", 100, "0.001", 200, 1e-7},
                        {"coulomb-circle, 200 charges", 200, "0.00025", 200, 1e-8}};

void measure_row(Report& report, const Row& row) {
  SystemOverrides changes;
  changes.set = {{"particles.count", fmt::format("{}", row.particles)},
                 {"particles.energy", fmt::format("{}", 0.8 * row.particles)},
                 {"integrator.step", row.step}};
  const System system = load_system("coulomb-circle", changes).system;
  const double t_end = system.dynamics.integrator.step * row.steps;
  World world(*system.table, system.dynamics);
  const std::vector<State> starts = Sampler(system).draw_all(world, 0);
  Observer silent;
  std::vector<State> states;
  const auto energy = [&](double t) {
    states.clear();
    for (int i = 0; i < world.size(); ++i) states.push_back(world.state_at(i, Time(t)));
    return energy_of(system.particles, states, system.dynamics, *system.table).total();
  };
  double change = 0.0, hits = 0.0, evaluations = 0.0;
  Best step;
  step.repeat(3, [&] {
    world.clear();
    for (std::size_t i = 0; i < starts.size(); ++i) world.add(system.particles[i], starts[i]);
    const double before = energy(0.0);
    world.run_until(t_end, silent);
    change = std::fabs(energy(t_end) / before - 1.0);
    hits = 0.0;
    for (int i = 0; i < world.size(); ++i) hits += static_cast<double>(world.hits(i));
    evaluations = static_cast<double>(world.step_counts().force_evaluations);
    return static_cast<double>(row.steps);
  });
  std::vector<geometry::Vector> x, force(states.size());
  for (const State& s : states) x.push_back(s.position);
  Best evaluation;
  evaluation.repeat(5, [&] {
    constexpr int times = 100;
    for (int k = 0; k < times; ++k)
      system.dynamics.forces->add_pairs(system.particles, x, nullptr, force);
    return static_cast<double>(times);
  });
  const double pieces = 1.0 + hits / row.steps;
  constexpr int stages = 11;  // of the default scheme
  report.add({row.name, "a step", step.each, step.ratio, "11 forces a piece",
              stages * pieces * evaluation.each / step.each,
              fmt::format("{:.2f} hits and {:.1f} forces a step, energy within {:.1e}",
                          hits / row.steps, evaluations / row.steps, change),
              hits > 0.0 && change < row.energy});
}

}  // namespace

void groups_at_walls(Report& report) {
  for (const Row& row : rows)
    if (report.wants(row.name)) measure_row(report, row);
}

}  // namespace carom::bench
