// CPU time of the question whether a step resolves its forces, beside a whole step in the widest
// lanes there are. Every step of these orbits is resolved, and the energy is what the scheme
// promises.
#include <fmt/format.h>

#include <carom/carom.hpp>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "carom/events/energy.hpp"
#include "carom/lanes/soft_lanes.hpp"
#include "forces/resolution.hpp"
#include "lane_starts.hpp"
#include "measuring.hpp"
#include "table.hpp"

namespace carom::bench {

namespace {

struct Row {
  const char* name;
  double energy;               ///< most that a particle's may change
  const char* text = nullptr;  ///< none: the built-in system
};
constexpr Row rows[] = {
    {"soft-lorentz", 1e-6},
    {"antidot-magnetic", 1e-6},
    {"typed bumps in a box", 1e-6,
     "[table]\nshape = \"rectangle\"\nwidth = 2\nheight = 2\n[[potential]]\nkind = \"expression\"\n"
     "expression = "
     "\"50*exp(-((x-1)^2+(y-1)^2)/(2*0.03^2))+0.2*cos(3*x)*sin(2*y)\"\n[particles]\nspeed = 1\n"
     "[integrator]\nstep = 0.01\n[initial]\nkind = \"rectangle\"\nmin = [0.1, 0.1]\nmax = [0.5, "
     "0.5]\n[run]\nt_max = 1\n"},
    {"typed Henon-Heiles", 1e-9,
     "[[potential]]\nkind = \"expression\"\nexpression = "
     "\"(x^2+y^2)/2+x^2*y-y^3/3\"\n[particles]\nspeed = 0.3\n"
     "[integrator]\nstep = 0.05\n[initial]\nkind = \"rectangle\"\nmin = [-0.2, -0.2]\nmax = [0.2, "
     "0.2]\n[run]\nt_max = 1\n"},
};

/// The states after each step.
struct Recorder final : Observer {
  std::vector<State> states;
  void sample(int, Time, const State& s) override { states.push_back(s); }
};

void measure_row(Report& report, const Row& row) {
  constexpr std::uint64_t trajectories = 64, steps = 500;
  const System system =
      row.text ? read_system(row.text, row.name).system : load_system(row.name).system;
  const Particle& particle = system.particles[0];
  const double step = system.dynamics.integrator.step, t_end = step * static_cast<double>(steps);
  World world(*system.table, system.dynamics);
  const Sampler sampler(system);
  std::vector<State> starts;
  Recorder recorder;
  double change = 0.0;
  const auto energy = [&](const State& s) {
    return energy_of(system.particles, std::span(&s, 1), system.dynamics, *system.table).total();
  };
  for (std::uint64_t i = 0; i < trajectories; ++i) {
    starts.push_back(sampler.draw(world, i, 0));
    world.clear();
    world.sample_every(step);
    world.add(particle, starts.back());
    world.run_until(t_end, recorder);
    change = std::fmax(change, std::fabs(energy(recorder.states.back()) - energy(starts.back())));
  }
  forces::ForceMap map(*system.dynamics.forces, particle);
  const forces::resolution::Span span =
      forces::resolution::span_of(step / forces::resolution::steps_a_radius, particle.omega);
  std::size_t resolved = 0;
  Best question;
  question.repeat(5, [&] {
    resolved = 0;
    for (const State& s : recorder.states) {
      const double speed = dot(s.velocity, s.velocity);
      resolved += map.resolves(s.position, speed, 0.25 * speed * step * step, span);
    }
    return static_cast<double>(recorder.states.size());
  });
  SoftLanes lanes(*system.table, system.dynamics, particle, available_instruction_sets().back());
  Best whole;
  whole.repeat(5, [&] {
    lanes.run_until(t_end, each_of(particle, starts), [](const LaneEnd&) {});
    return static_cast<double>(steps * trajectories);
  });
  report.add({std::string(row.name) + ", a question", "scalar", question.each, question.ratio,
              "a whole step", whole.each / question.each,
              fmt::format("{} of {} steps resolved, energy within {:.1e}", resolved,
                          recorder.states.size(), change),
              resolved == recorder.states.size() && change < row.energy});
}

}  // namespace

void questions_of_resolution(Report& report) {
  for (const Row& row : rows)
    if (report.wants(row.name)) measure_row(report, row);
}

}  // namespace carom::bench
