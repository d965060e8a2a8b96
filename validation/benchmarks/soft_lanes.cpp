// CPU time of one step of a particle under forces, in lanes of every instruction set of this machine, beside the
// scalar engine and a chain of dependent square roots and divisions in the same run. All ends must be the same
// bits on every row, and the energy must be what the scheme promises.
#include <bit>
#include <carom/carom.hpp>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <string>
#include <vector>

#include "carom/events/energy.hpp"
#include "carom/lanes/soft_lanes.hpp"
#include "measuring.hpp"

namespace {

using carom::State;

struct Row {
  const char* name;
  double energy;  ///< most that a particle's may change
  const char* text = nullptr;  ///< TOML but for [initial] and [run]; none: the built-in system
};
constexpr Row rows[] = {
    {"soft-lorentz", 1e-6},
    {"antidot-magnetic", 1e-6},
    {"gravity in a circle", 1e-9,
     "[table]\nshape = \"circle\"\nradius = 1\n[[potential]]\nkind = \"linear\"\nforce = [0, -1]\n"
     "[particles]\nspeed = 1.5\n[integrator]\nstep = 0.05\n"},
    {"well in a stadium", 1e-9,
     "[table]\nshape = \"stadium\"\nhalf_length = 1\nradius = 1\n[[potential]]\nkind = \"harmonic\"\nomega = 1\n"
     "[particles]\nspeed = 1.5\n[integrator]\nstep = 0.1\n"},
    {"Henon-Heiles in a field", 1e-9,
     "[table]\nshape = \"circle\"\nradius = 0.5\n[[potential]]\nkind = \"henon-heiles\"\n[field]\nB = 1\n"
     "[particles]\nspeed = 0.7\n[integrator]\nstep = 0.05\n"},
    {"discs among bumps", 1e-6,
     "[table]\nshape = \"lorentz\"\nlattice = \"triangular\"\nspacing = 1\nradius = 0.2\n[[potential]]\nkind = \"fermi\"\n"
     "radius = 0.3\nsoftness = 0.05\nheight = 0.3\nlattice = true\n[particles]\nenergy = 0.5\n[integrator]\nstep = 0.05\n"},
};

carom::System system_of(const Row& row) {
  if (!row.text) return carom::load_system(row.name).system;
  return carom::read_system(std::string(row.text) + "[initial]\nkind = \"uniform\"\n[run]\nt_max = 1\n", row.name).system;
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

double energy_of(const carom::System& system, const State& state) {
  return carom::energy_of(system.particles, std::span(&state, 1), system.dynamics, *system.table).total();
}

bool measure_row(const Row& row, std::uint64_t steps, int times) {
  constexpr std::size_t trajectories = 256;
  const carom::System system = system_of(row);
  const double t_end = system.dynamics.integrator.step * static_cast<double>(steps);
  const double done = static_cast<double>(steps) * static_cast<double>(trajectories);
  carom::World world(*system.table, system.dynamics);
  const carom::Sampler sampler(system);
  std::vector<State> starts, ends(trajectories);
  for (std::uint64_t i = 0; i < trajectories; ++i) starts.push_back(sampler.draw(world, i, 0));

  carom::bench::Best scalar;
  std::uint64_t hits = 0;
  scalar.repeat(2, [&] {
    carom::Observer nobody;
    hits = 0;
    for (std::size_t i = 0; i < trajectories; ++i) {
      world.clear();
      world.add(system.particles[0], starts[i]);
      world.run_until(t_end, nobody);
      ends[i] = world.state(0);
      hits += world.hits(0);
    }
    return done;
  });
  const std::uint64_t expected = digest_of(ends);
  double change = 0.0;
  for (std::size_t i = 0; i < trajectories; ++i)
    change = std::fmax(change, std::fabs(energy_of(system, ends[i]) - energy_of(system, starts[i])));
  std::printf("%-24s scalar %7.1f (%6.2f)", row.name, scalar.each, scalar.ratio);
  bool same = true;
  for (const carom::InstructionSet set : carom::available_instruction_sets()) {
    carom::SoftLanes lanes(*system.table, system.dynamics, set);
    carom::bench::Best best;
    best.repeat(times, [&] {
      std::vector<carom::SoftLanes::Walk> walks;
      for (const State& start : starts) walks.push_back({start});
      lanes.run(system.particles[0], walks, t_end, {}, [](std::size_t, std::size_t, const State&) {});
      for (std::size_t i = 0; i < trajectories; ++i) ends[i] = walks[i].state;
      return done;
    });
    same = same && digest_of(ends) == expected;
    std::printf("  %s %6.1f (%5.2f; %4.2f of scalar)", carom::name_of(set), best.each, best.ratio,
                best.ratio / scalar.ratio);
  }
  const bool right = change < row.energy;
  if (hits > 0) std::printf("  %.1f steps a hit", done / static_cast<double>(hits));
  std::printf("  energy within %.1e %s  bits %s\n", change, right ? "right" : "WRONG", same ? "equal" : "DIFFER");
  return same && right;
}

}  // namespace

/// Arguments: steps of each particle, repetitions, a name's beginning.
int main(int argc, char** argv) {
  const std::uint64_t steps = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1000;
  const int times = argc > 2 ? std::atoi(argv[2]) : 5;
  std::printf("CPU ns a step under forces, best of %d (in links of 1 + 1/sqrt x)\n", times);
  bool good = true;
  for (const Row& row : rows)
    if (argc < 4 || std::string(row.name).starts_with(argv[3])) good &= measure_row(row, steps, times);
  return good ? 0 : 1;
}
