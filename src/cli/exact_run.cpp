#include "cli/exact_run.hpp"

#include "carom/base/error.hpp"
#include "carom/ensemble/sampler.hpp"
#include "carom/ensemble/single_run.hpp"
#include "carom/events/world.hpp"
#include "cli/run_in_balls.hpp"

namespace carom::cli {

namespace {

void draw_start(const Options& options, LoadedSystem& loaded) {
  const System& system = loaded.system;
  check_start(system);
  if (system.initial.kind == InitialCondition::Kind::point) return;
  const std::uint64_t trajectory =
      options.trajectory.empty() ? 0 : whole_number(options.trajectory, "--trajectory", 0);
  const World world(*system.table);
  const State state = draw_initial_state(system, world, trajectory, 0);
  loaded.exact.start = exact_start(state);
}

}  // namespace

void check_form(const System& system, const char* option) {
  const auto refuse = [&](const char* what, const char* expected) {
    throw InputError(Place{"command line", 0, 0, option}, std::string(what) + " no exact form", expected);
  };
  if (system.dynamics.forces && !system.dynamics.forces->empty())
    refuse("[[potential]] and [interaction] have", "a system without forces, or double precision");
  if (system.of_discs()) refuse("hard discs have", "point particles, or double precision");
  if (system.particles.size() > 1)
    refuse("several particles have", "particles.count = 1, or double precision");
  if (!system.injections.empty()) refuse("[[injection]] has", "a system without it, or double precision");
}

ExactStart exact_start(const State& state) {
  ExactStart start;
  start.position = {state.position.x, state.position.y};
  start.direction = {state.velocity.x, state.velocity.y};
  start.wall = state.wall;
  start.u = state.u;
  return start;
}

LoadedSystem load_exact_run(const Options& options) {
  LoadedSystem loaded = load_system(options.system, run_overrides(options));
  check_form(loaded.system, "--precision");
  draw_start(options, loaded);
  return loaded;
}

std::string wall_of(const System& system, int wall) {
  return wall < 0 ? std::string() : system.table->walls[static_cast<std::size_t>(wall)].name;
}

bool says_rescaled(const System& system, bool rescaled) {
  return rescaled && system.initial.kind == InitialCondition::Kind::point;
}

}  // namespace carom::cli
