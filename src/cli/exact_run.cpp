#include "cli/exact_run.hpp"

#include <fmt/format.h>

#include "carom/base/error.hpp"
#include "carom/ensemble/sampler.hpp"
#include "carom/ensemble/single_run.hpp"
#include "carom/events/world.hpp"
#include "cli/run_in_balls.hpp"

namespace carom::cli {

namespace {

void draw_start(const Options& options, LoadedSystem& loaded) {
  const System& system = loaded.system;
  if (system.initial.kind == InitialCondition::Kind::point) return;  // the orbit asks whether it is one, exactly
  check_start(system);
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

Json end_json(const System& system, const PrintedEnd& end, double seconds, double cpu_seconds) {
  Json json = Json::object();
  add_common_keys(json, system, 1, seconds, cpu_seconds);
  json.set("status", end.status);
  json.set("collisions", end.collisions);
  const std::string wall = wall_of(system, end.wall);
  json.set("wall", wall.empty() ? Json() : Json(wall));
  json.set("t", end.t).set("x", end.x).set("y", end.y).set("vx", end.vx).set("vy", end.vy);
  json.set("cell", Json::array().push(end.cell.first).push(end.cell.second));
  if (end.hole >= 0) json.set("hole", system.table->holes[static_cast<std::size_t>(end.hole)].name);
  if (!end.reason.empty()) json.set("reason", end.reason);
  return json;
}

std::string end_text(const System& system, const PrintedEnd& end) {
  std::string text = fmt::format("{}\n", system.title.empty() ? system.name : system.title);
  text += fmt::format("  status        {}", end.status);
  if (end.hole >= 0)
    text += fmt::format(" through '{}'", system.table->holes[static_cast<std::size_t>(end.hole)].name);
  if (!end.reason.empty()) text += ": " + end.reason;
  for (const std::string& note : end.notes) text += "\n  " + note;
  text += fmt::format("\n  collisions    {}", grouped(end.collisions));
  const std::string wall = wall_of(system, end.wall);
  if (!wall.empty()) text += fmt::format(", the last on '{}'", wall);
  text += fmt::format("\n  t             {}\n  position      {}, {}", end.t, end.x, end.y);
  if (system.table->lattice) text += fmt::format("   in cell {}, {}", end.cell.first, end.cell.second);
  return text + fmt::format("\n  velocity      {}, {}\n", end.vx, end.vy);
}

bool says_rescaled(const System& system, bool rescaled) {
  return rescaled && system.initial.kind == InitialCondition::Kind::point;
}

}  // namespace carom::cli
