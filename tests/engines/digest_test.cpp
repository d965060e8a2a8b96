// Digests tell trajectories apart, also those that meet no wall, and depend on nothing but these.
#include <gtest/gtest.h>

#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "analyses/systems.hpp"
#include "carom/analyses/diffusion.hpp"
#include "carom/analyses/escape.hpp"

namespace carom {
namespace {

using Settings = std::vector<std::pair<std::string, std::string>>;

System built_in(const std::string& name, Settings settings) {
  SystemOverrides overrides;
  overrides.set = std::move(settings);
  return load_system(name, overrides).system;
}

struct Way {
  std::optional<InstructionSet> lanes;
  int threads;
  std::uint64_t block;
};
EscapeResult escape(const System& system, const Way& way = {std::nullopt, 1, 1024}) {
  EscapeOptions how;
  how.lanes = way.lanes;
  how.threads = way.threads;
  how.block = way.block;
  return run_escape(system, how);
}
DiffusionResult diffusion(const System& system, const Way& way = {std::nullopt, 1, 1024}) {
  DiffusionOptions how;
  how.lanes = way.lanes;
  how.threads = way.threads;
  how.block = way.block;
  return run_diffusion(system, how);
}

// None of them meets a wall, or ends before t_max.
const char* gas_of_discs = R"(
[lattice]
vectors = [[4, 0], [0, 4]]
[interaction]
kind = "hard-discs"
radius = 0.4
[particles]
count = 4
[initial]
kind = "uniform"
[run]
t_max = 10
trajectories = 30
)";
const char* pair_in_range = R"(
[lattice]
vectors = [[3, 0], [0, 3]]
[interaction]
kind = "soft-sphere"
diameter = 0.05
[particles]
count = 2
[initial]
kind = "uniform"
[integrator]
step = 0.02
[run]
t_max = 5
trajectories = 30
)";
// Free flights from one bump to the next.
const char* far_bumps = R"(
[lattice]
vectors = [[3, 0], [0, 3]]
[[potential]]
kind = "fermi"
radius = 0.5
softness = 0.02
height = 0.3
lattice = true
[particles]
energy = 0.5
[initial]
kind = "uniform"
[integrator]
step = 0.02
[run]
t_max = 10
trajectories = 40
)";

const char* far_from_walls = R"(
[table]
shape = "rectangle"
width = 100
height = 100
[initial]
kind = "rectangle"
min = [40, 40]
max = [60, 60]
[integrator]
step = 0.1
[run]
t_max = 10
trajectories = 30
)";

// Another seed, step, height, mass, speed, time or table is another digest: of systems without a
// wall as well.
TEST(Digest, TellsIntegratedMotionApart) {
  std::set<std::uint64_t> escapes, diffusions;
  std::size_t all = 0;
  const auto look_at = [&](const System& system, const std::string& what) {
    ++all;
    const EscapeResult result = escape(system);
    EXPECT_EQ(result.counts.collisions + result.counts.lost + result.counts.escaped, 0u) << what;
    EXPECT_TRUE(escapes.insert(result.digest).second) << "escape: " << what;
    EXPECT_TRUE(diffusions.insert(diffusion(system).digest).second) << "diffusion: " << what;
  };
  const Settings usual{{"run.trajectories", "40"}, {"run.t_max", "10"}};
  look_at(built_in("soft-lorentz", usual), "as it is");
  for (const auto& [key, value] : Settings{{"run.seed", "3"},
                                           {"integrator.step", "0.05"},
                                           {"integrator.scheme", "\"velocity-verlet\""},
                                           {"potential[0].height", "1.0000000000000002"},
                                           {"particles.mass", "2"},
                                           {"run.t_max", "10.5"},
                                           {"particles.energy", "0.6"},
                                           {"field.B", "1e-3"}}) {
    Settings other = usual;
    other.emplace_back(key, value);
    look_at(built_in("soft-lorentz", other), key);
  }
  look_at(built_in("henon-heiles", usual), "henon-heiles");
  for (const char* text : {gas_of_discs, pair_in_range, far_bumps}) {
    System system = make_system(text);
    look_at(system, text);
    system.run.seed = 2;
    look_at(system, std::string("another seed: ") + text);
  }
  System free = make_system(far_from_walls);
  free.dynamics.everywhere = true;
  look_at(free, "integrated without a force");
  free.run.seed = 2;
  look_at(free, "another seed: integrated without a force");
  EXPECT_EQ(escapes.size(), all);
}

// The same on all threads, in blocks of any size and in lanes.
TEST(Digest, IntegratedMotionHasOneDigestInEveryWay) {
  std::vector<System> systems{make_system(gas_of_discs), make_system(pair_in_range),
                              make_system(far_bumps)};
  const auto add = [&](const std::string& name, const char* t_max, const char* trajectories,
                       Settings settings = {}) {
    settings.emplace_back("run.t_max", t_max);
    settings.emplace_back("run.trajectories", trajectories);
    systems.push_back(built_in(name, settings));
  };
  add("soft-lorentz", "2.53", "150");
  add("soft-lorentz", "5", "20", {{"integrator.scheme", "\"arkode\""}});
  add("antidot-magnetic", "3", "150");
  add("henon-heiles", "20", "70", {{"particles.energy", "0.2"}});
  systems.back().initial.kind = InitialCondition::Kind::rectangle;
  systems.back().initial.low = {-0.3, -0.3};
  systems.back().initial.high = {0.3, 0.3};
  add("wigner", "0.5", "12");
  add("coulomb-circle", "0.1", "12");
  int in_lanes = 0;
  for (const System& system : systems) {
    SCOPED_TRACE(system.title);
    const std::uint64_t escapes = escape(system).digest, diffusions = diffusion(system).digest;
    std::vector<std::optional<InstructionSet>> all{std::nullopt};
    if (diffusion(system, {InstructionSet::baseline, 1, 64}).lanes)
      for (const InstructionSet set : available_instruction_sets()) all.emplace_back(set);
    for (const auto& lanes : all)
      for (const auto& [threads, block] : {std::pair{1, 7u}, {2, 1u}, {3, 64u}}) {
        const Way way{lanes, threads, block};
        EXPECT_EQ(escape(system, way).digest, escapes)
            << (lanes ? name_of(*lanes) : "scalar") << ' ' << threads;
        EXPECT_EQ(diffusion(system, way).digest, diffusions)
            << (lanes ? name_of(*lanes) : "scalar") << ' ' << threads;
      }
    in_lanes += all.size() > 1;
  }
  EXPECT_EQ(in_lanes, 3);
}

// Archives and papers quote them.
TEST(Digest, FreeFlightsKeepTheirDigest) {
  const Settings few{{"run.trajectories", "500"}, {"run.t_max", "20"}};
  EXPECT_EQ(escape(built_in("stadium", few)).digest, 0x8626ef175405a0fbu);
  EXPECT_EQ(escape(built_in("magnetic-square", few)).digest, 0x06b64168cc2535f5u);
  EXPECT_EQ(diffusion(built_in("lorentz-triangular", few)).digest, 0xabd0590aa16a3ff5u);
}

}  // namespace
}  // namespace carom
