#include "analyses/run/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "carom/integrators/scheme.hpp"
#include "cli/common.hpp"
#include "cli/reports/aligned.hpp"
#include "cli/reports/doubts.hpp"
#include "files/describe/json_out.hpp"

namespace carom::cli {

using files::Json;

namespace {

std::string status_of(const RunEnd& particle, bool interrupted) {
  switch (particle.progress.fate) {
    case Fate::survived:
      return interrupted ? "interrupted" : "completed";
    case Fate::capped:
      return "completed";
    default:
      return name_of(particle.progress.fate);
  }
}

std::string wall_of(const System& system, const RunEnd& particle) {
  const int wall = particle.progress.last_wall;
  return wall < 0 ? std::string() : system.table->walls[static_cast<std::size_t>(wall)].name;
}

void add_end(Json& json, const System& system, const RunEnd& particle) {
  const std::string wall = wall_of(system, particle);
  json.set("wall", wall.empty() ? Json() : Json(wall));
  json.set("t", particle.t);
  json.set("x", particle.x);
  json.set("y", particle.y);
  json.set("vx", particle.vx);
  json.set("vy", particle.vy);
  json.set("cell", Json::array().push(particle.cell.first).push(particle.cell.second));
  files::add_numbers(json, particle.energy_error);
  if (is_failure(particle.progress.fate) && !particle.report.empty())
    add_report(json, particle.report);
  const Trust& trust = particle.trust;
  json.set("trusted_collisions", trust.known ? Json(trust.hits) : Json());
  json.set("trusted_time", trust.known ? Json(trust.time.value()) : Json());
  json.set("trust_tolerance", system.run.trust_tolerance);
  const int hole = particle.progress.hole;
  if (hole >= 0) json.set("hole", system.table->holes[static_cast<std::size_t>(hole)].name);
}

std::string trust_text(const System& system, const RunEnd& particle) {
  const Trust& trust = particle.trust;
  if (!trust.known)
    return "not estimated where motion is integrated, discs meet, or walls are Bézier curves, "
           "scatter or are passed";
  if (trust.open && trust.time == particle.progress.end)
    return fmt::format("to the end: errors below {} of the table's size",
                       system.run.trust_tolerance);
  return fmt::format(
      "{}, until t = {:.6g}\n"
      "                then errors exceed {} of the table's size or change a wall",
      counted(trust.hits, "collision"), trust.time.value(), system.run.trust_tolerance);
}

std::string end_text(const System& system, const RunEnd& particle, bool interrupted) {
  std::string text = fmt::format("  status        {}", status_of(particle, interrupted));
  if (particle.progress.fate == Fate::unbounded) text += ": escaped to infinity, no wall follows";
  const int hole = particle.progress.hole;
  if (hole >= 0)
    text += fmt::format(" through '{}'", system.table->holes[static_cast<std::size_t>(hole)].name);
  text += fmt::format("\n  collisions    {}", grouped(particle.progress.hits));
  const std::string wall = wall_of(system, particle);
  if (!wall.empty()) text += fmt::format(", the last on '{}'", wall);
  if (system.of_discs())
    text += fmt::format("\n  contacts      {}", grouped(particle.progress.contacts));
  text += fmt::format("\n  t             {}\n  position      {}, {}", particle.t, particle.x,
                      particle.y);
  if (system.table->lattice)
    text += fmt::format("   in cell {}, {}", particle.cell.first, particle.cell.second);
  const EnergyError& error = particle.energy_error;
  text +=
      fmt::format("\n  velocity      {}, {}\n  energy error  {:.2g} at the end, {:.2g} at most\n",
                  particle.vx, particle.vy, error.end, error.largest);
  if (!system.has_forces())
    text += fmt::format("  trusted       {}\n", trust_text(system, particle));
  return text;
}

// A line for each of several particles, with as many digits as the width allows.
std::string particles_text(const System& system, const SingleRunResult& result, bool verbose) {
  constexpr std::size_t most = 20;
  const std::size_t all = result.particles.size(), rows = verbose ? all : std::min(all, most);
  const bool forces = system.has_forces();
  const bool trusted = !forces && result.particles.front().trust.known;
  std::vector<Column> columns;
  for (int digits = 6; digits >= 3; --digits) {
    columns = {{"particle", {}}, {"status", {}, true}, {"collisions", {}}};
    if (system.of_discs()) columns.push_back({"contacts", {}});
    if (trusted) columns.push_back({"trusted", {}});
    for (const std::string name : {"t", "x", "y", "vx", "vy"})
      columns.push_back({name, {}, false, name.ends_with("y")});
    for (std::size_t i = 0; i < rows; ++i) {
      const RunEnd& p = result.particles[i];
      std::vector<std::string> cells{fmt::format("{}", i), status_of(p, result.interrupted),
                                     grouped(p.progress.hits)};
      if (system.of_discs()) cells.push_back(grouped(p.progress.contacts));
      if (trusted) cells.push_back(grouped(p.trust.hits));
      for (const double x : {p.t, p.x, p.y, p.vx, p.vy})
        cells.push_back(fmt::format("{:.{}g}", x, digits));
      for (std::size_t c = 0; c < columns.size(); ++c) columns[c].cells.push_back(cells[c]);
    }
    if (width_of(aligned(columns)) <= line_width) break;
  }
  std::string text = "\n" + fitted(columns);
  if (rows < all) text += fmt::format("  and {} more; --verbose prints all\n", grouped(all - rows));
  const EnergyError energy = energy_error_of(result);
  return text + fmt::format("\n  energy error  {:.2g} at the end, {:.2g} at most\n", energy.end,
                            energy.largest);
}

std::string state_error_text(const System& system, const StateError& error, double end) {
  const bool adaptive = is_adaptive(system.dynamics.integrator.scheme);
  std::string text =
      fmt::format("  state error   {:.2g} in position, {:.2g} in velocity, by {}\n", error.position,
                  error.velocity, adaptive ? "a finer tolerance" : "half the step");
  if (error.until < end)
    text +=
        fmt::format("                at t = {:.6g}: no later times are compared\n", error.until);
  return text;
}

/// What was compared with another run, and what was not.
std::string checks_text(const SingleRunResult& result) {
  const RunEnd& first = result.particles.front();
  const double end = first.progress.end.value();
  std::string checked = "energy", left = "rounding along the orbit";
  if (first.trust.known) {
    checked = "walls by exact signs, the true orbit as far as it is trusted";
    left = first.trust.time.value() < end ? "what follows (--precision certified)" : "";
  } else if (result.state_error) {
    checked = "energy, resolution of the forces, half the step";
    left = result.state_error->until < end ? "later times" : "";
  } else if (!result.no_state_error.empty()) {
    left = "half the step";
  }
  if (!left.empty()) checked += "; not checked: " + left;
  return folded("  checked       " + checked, std::string(16, ' ')) + "\n";
}

/// Why the energy cannot be trusted; "" if it is kept.
std::string energy_note(const System& system, const SingleRunResult& result) {
  return energy_doubt(system, energy_error_of(result));
}

}  // namespace

std::string run_status(const SingleRunResult& result) {
  if (result.particles.size() == 1) return status_of(result.particles.front(), result.interrupted);
  const auto any = [&](Fate fate) {
    return std::any_of(result.particles.begin(), result.particles.end(),
                       [&](const auto& p) { return p.progress.fate == fate; });
  };
  for (const Fate fate : {Fate::lost, Fate::unresolved})
    if (any(fate)) return name_of(fate);
  return result.interrupted ? "interrupted" : "completed";
}

Json run_json(const System& system, const SingleRunResult& result, const std::string& status,
              const std::string& output) {
  Json json = Json::object();
  add_common_keys(json, system, 1, result.seconds, result.cpu_seconds);
  json.set("status", status);
  json.set("collisions", result.collisions);
  if (system.of_discs()) json.set("contacts", result.contacts);
  json.set("decisions", decisions_json(result.decisions));
  add_steps(json, system, result.steps);
  if (result.particles.size() == 1) {
    add_end(json, system, result.particles.front());
  } else {
    Json particles = Json::array();
    for (const RunEnd& particle : result.particles) {
      Json one = Json::object();
      one.set("status", status_of(particle, result.interrupted));
      one.set("collisions", particle.progress.hits);
      if (system.of_discs()) one.set("contacts", particle.progress.contacts);
      add_end(one, system, particle);
      particles.push(std::move(one));
    }
    json.set("particles", std::move(particles));
  }
  if (result.state_error) {
    Json error = Json::object();
    error.set("position", result.state_error->position);
    error.set("velocity", result.state_error->velocity);
    error.set("until", result.state_error->until);
    json.set("state_error", std::move(error));
  } else if (!result.no_state_error.empty()) {
    json.set("state_error", Json()).set("state_error_reason", result.no_state_error);
  }
  const std::string note = energy_note(system, result);
  if (!note.empty()) json.set("note", note);
  if (!output.empty()) json.set("archive", output);
  return json;
}

std::string run_text(const System& system, const SingleRunResult& result, const std::string& status,
                     const std::string& output, bool verbose) {
  std::string text = doubts_of(system, result).folded_text() + heading(system);
  if (result.particles.size() == 1)
    text += end_text(system, result.particles.front(), result.interrupted);
  else
    text += fmt::format("{}: {}, {}{}\n", status, counted(result.particles.size(), "particle"),
                        counted(result.collisions, "collision"),
                        system.of_discs() ? ", " + counted(result.contacts, "contact") : "") +
            particles_text(system, result, verbose);
  if (const std::string steps = steps_text(system, result.steps); !steps.empty())
    text += fmt::format("  integration   {}\n", steps);
  if (result.state_error) {
    double end = 0.0;
    for (const RunEnd& particle : result.particles)
      end = std::max(end, particle.progress.end.value());
    text += state_error_text(system, *result.state_error, end);
  } else if (!result.no_state_error.empty()) {
    text += folded("  state error   none: " + result.no_state_error, "                ") + "\n";
  }
  text += fmt::format("  computed in   {}\n", short_duration(result.seconds));
  text += checks_text(result);
  if (verbose) text += fmt::format("  {}\n", decisions_text(result.decisions));
  if (!output.empty()) text += fmt::format("  archive       {}\n", output);
  return text;
}

}  // namespace carom::cli
