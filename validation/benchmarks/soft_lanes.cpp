// CPU time of one step of a particle under forces, in lanes of every instruction set of this
// machine, beside the scalar engine and a chain of dependent square roots and divisions in the same
// run. All ends must be the same bits on every row, and the energy must be what the scheme
// promises.
#include <fmt/format.h>

#include <bit>
#include <carom/carom.hpp>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "carom/events/energy.hpp"
#include "carom/lanes/soft_lanes.hpp"
#include "lane_starts.hpp"
#include "measuring.hpp"
#include "table.hpp"

namespace carom::bench {

namespace {

struct Row {
  const char* name;
  double energy;               ///< most that a particle's may change
  const char* text = nullptr;  ///< TOML but for [initial] and [run]; none: the built-in system
};
constexpr Row rows[] = {
    {"soft-lorentz", 1e-6},
    {"antidot-magnetic", 1e-6},
    {"gravity in a circle", 1e-9,
     "[table]\nshape = \"circle\"\nradius = 1\n[[potential]]\nkind = \"linear\"\nforce = [0, -1]\n"
     "[particles]\nspeed = 1.5\n[integrator]\nstep = 0.05\n"},
    {"well in a stadium", 1e-9,
     "[table]\nshape = \"stadium\"\nhalf_length = 1\nradius = 1\n[[potential]]\nkind = "
     "\"harmonic\"\nomega = 1\n"
     "[particles]\nspeed = 1.5\n[integrator]\nstep = 0.1\n"},
    {"Henon-Heiles in a field", 1e-9,
     "[table]\nshape = \"circle\"\nradius = 0.5\n[[potential]]\nkind = "
     "\"henon-heiles\"\n[field]\nB = 1\n"
     "[particles]\nspeed = 0.7\n[integrator]\nstep = 0.05\n"},
    {"discs among bumps", 1e-6,
     "[table]\nshape = \"lorentz\"\nlattice = \"triangular\"\nspacing = 1\nradius = "
     "0.2\n[[potential]]\nkind = \"fermi\"\n"
     "radius = 0.3\nsoftness = 0.05\nheight = 0.3\nlattice = true\n[particles]\nenergy = "
     "0.5\n[integrator]\nstep = 0.05\n"},
};

System system_of(const Row& row) {
  if (!row.text) return load_system(row.name).system;
  return read_system(std::string(row.text) + "[initial]\nkind = \"uniform\"\n[run]\nt_max = 1\n",
                     row.name)
      .system;
}

std::uint64_t digest_of(const std::vector<State>& ends) {
  std::uint64_t hash = 0;
  for (const State& s : ends)
    for (const std::uint64_t word :
         {std::bit_cast<std::uint64_t>(s.position.x), std::bit_cast<std::uint64_t>(s.position.y),
          std::bit_cast<std::uint64_t>(s.velocity.x), std::bit_cast<std::uint64_t>(s.velocity.y),
          static_cast<std::uint64_t>(s.cell.first), static_cast<std::uint64_t>(s.cell.second)})
      hash = (hash ^ word) * 0x9e3779b97f4a7c15u, hash ^= hash >> 29;
  return hash;
}

double energy_of(const System& system, const State& state) {
  return carom::energy_of(system.particles, std::span(&state, 1), system.dynamics, *system.table)
      .total();
}

void measure_row(Report& report, const Row& row) {
  constexpr std::size_t trajectories = 256;
  constexpr std::uint64_t steps = 1000;
  const System system = system_of(row);
  const double t_end = system.dynamics.integrator.step * static_cast<double>(steps);
  const double done = static_cast<double>(steps) * static_cast<double>(trajectories);
  World world(*system.table, system.dynamics);
  const Sampler sampler(system);
  std::vector<State> starts, ends(trajectories);
  for (std::uint64_t i = 0; i < trajectories; ++i) starts.push_back(sampler.draw(world, i, 0));

  Best scalar;
  std::uint64_t hits = 0;
  scalar.repeat(2, [&] {
    Observer silent;
    hits = 0;
    for (std::size_t i = 0; i < trajectories; ++i) {
      world.clear();
      world.add(system.particles[0], starts[i]);
      world.run_until(t_end, silent);
      ends[i] = world.state(0);
      hits += world.hits(0);
    }
    return done;
  });
  const std::uint64_t expected = digest_of(ends);
  double change = 0.0;
  for (std::size_t i = 0; i < trajectories; ++i)
    change =
        std::fmax(change, std::fabs(energy_of(system, ends[i]) - energy_of(system, starts[i])));
  const bool right = change < row.energy;
  for (const InstructionSet set : available_instruction_sets()) {
    SoftLanes lanes(*system.table, system.dynamics, system.particles[0], set);
    Best best;
    best.repeat(5, [&] {
      lanes.run_until(t_end, each_of(system.particles[0], starts),
                      [&](const LaneEnd& end) { ends[end.tag] = end.state; });
      return done;
    });
    const bool same = digest_of(ends) == expected;
    report.add(
        {std::string(row.name) + ", a step", name_of(set), best.each, best.ratio, "scalar",
         scalar.each / best.each,
         fmt::format(
             "ends {}, energy within {:.1e}{}", same ? "equal" : "DIFFER", change,
             hits > 0 ? fmt::format("; {:.1f} steps a hit", done / static_cast<double>(hits)) : ""),
         same && right});
  }
}

}  // namespace

void steps_under_forces(Report& report) {
  for (const Row& row : rows)
    if (report.wants(row.name)) measure_row(report, row);
}

}  // namespace carom::bench
