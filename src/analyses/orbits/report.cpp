#include "analyses/orbits/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <complex>
#include <memory>
#include <utility>
#include <vector>

#include "cli/common.hpp"
#include "cli/reports/aligned.hpp"
#include "cli/reports/doubts.hpp"

namespace carom::cli {

using files::Json;

namespace {

Json points_json(const Table& table, const PeriodicOrbit& orbit) {
  Json points = Json::array();
  for (const OrbitHit& hit : orbit.hits) {
    Json point = Json::object();
    point.set("wall", table.wall(hit.wall).name).set("s", hit.s).set("v_parallel", hit.v_parallel);
    point.set("x", hit.position.x).set("y", hit.position.y);
    point.set("vx", hit.velocity.x).set("vy", hit.velocity.y);
    point.set("flight_time", hit.flight_time);
    if (table.lattice) point.set("step", Json::array().push(hit.step.first).push(hit.step.second));
    if (hit.hole >= 0) point.set("hole", table.holes[static_cast<std::size_t>(hit.hole)].name);
    points.push(std::move(point));
  }
  return points;
}

Json one_json(const Table& table, const PeriodicOrbit& orbit, const std::string& word) {
  Json walls = Json::array(), multipliers = Json::array();
  for (const OrbitHit& hit : orbit.hits) walls.push(table.wall(hit.wall).name);
  for (const std::complex<double>& m : orbit.multipliers)
    multipliers.push(Json::array().push(m.real()).push(m.imag()));
  Json json = Json::object();
  json.set("hits", orbit.hits.size()).set("period", orbit.period).set("length", orbit.length);
  json.set("action", orbit.action).set("trace", orbit.trace).set("trace_error", orbit.trace_error);
  json.set("stability", name_of(orbit.stability)).set("multipliers", std::move(multipliers));
  json.set("maslov", orbit.maslov ? Json(*orbit.maslov) : Json());
  json.set("family", orbit.family).set("position_error", orbit.position_error);
  json.set("length_error", orbit.length_error).set("copies", orbit.copies);
  json.set("reduced", Json::object()
                          .set("order", orbit.reduced.order)
                          .set("period", orbit.reduced.period)
                          .set("trace", orbit.reduced.trace)
                          .set("multiplier", orbit.reduced.multiplier));
  if (table.lattice)
    json.set("shift", Json::array().push(orbit.shift.first).push(orbit.shift.second));
  json.set("word", word).set("walls", std::move(walls)).set("points", points_json(table, orbit));
  return json;
}

Json proof_json(const ProofOfOrbit& proof, int digits) {
  Json json = Json::object();
  json.set("proven", proof.proven);
  if (!proof.proven) return json.set("reason", proof.reason);
  json.set("digits", digits).set("period", proof.period);
  json.set("length", proof.length).set("trace", proof.trace);
  if (!proof.multiplier.empty()) json.set("multiplier", proof.multiplier);
  Json x = Json::array(), y = Json::array();
  for (const std::string& number : proof.x) x.push(number);
  for (const std::string& number : proof.y) y.push(number);
  return json.set("x", std::move(x)).set("y", std::move(y));
}

std::string proofs_text(const ProofsOfOrbits& proofs) {
  std::string text = fmt::format("\nproven, with {}: period, multiplier\n",
                                 counted(static_cast<std::uint64_t>(proofs.digits), "decimal"));
  for (std::size_t i = 0; i < proofs.orbits.size(); ++i) {
    const ProofOfOrbit& proof = proofs.orbits[i];
    text += fmt::format("  {:3}  ", i + 1);
    if (!proof.proven)
      text += "not proven: " + proof.reason + "\n";
    else
      text +=
          proof.period + "  " + (proof.multiplier.empty() ? "not real" : proof.multiplier) + "\n";
  }
  return text + "\n";
}

Json zeta_json(const CycleExpansion& cycles) {
  Json orders = Json::array();
  for (const CycleOrder& order : cycles.orders)
    orders.push(Json::object()
                    .set("hits", order.hits)
                    .set("spectral", order.spectral)
                    .set("dynamical", order.dynamical)
                    .set("lambda", order.lambda));
  return Json::object()
      .set("escape_rate", cycles.escape_rate)
      .set("error", cycles.error)
      .set("lambda", cycles.lambda)
      .set("lambda_error", cycles.lambda_error)
      .set("orders", std::move(orders));
}

std::string zeta_text(const CycleExpansion& cycles) {
  std::vector<Column> columns{
      {"hits", {}}, {"spectral determinant", {}}, {"zeta function", {}}, {"Lyapunov exponent", {}}};
  for (const CycleOrder& order : cycles.orders) {
    columns[0].cells.push_back(fmt::format("{}", order.hits));
    columns[1].cells.push_back(fmt::format("{:.14f}", order.spectral));
    columns[2].cells.push_back(fmt::format("{:.14f}", order.dynamical));
    columns[3].cells.push_back(fmt::format("{:.14f}", order.lambda));
  }
  return "\nescape rate and exponent of the repeller, by cycle expansion\n" + aligned(columns) +
         fmt::format("  escape rate        {:.14f}, the last order changed it by {:.1e}\n",
                     cycles.escape_rate, cycles.error) +
         fmt::format("  Lyapunov exponent  {:.14f}, the last order changed it by {:.1e}\n\n",
                     cycles.lambda, cycles.lambda_error);
}

constexpr std::size_t most_rows = 30, least_letters = 10;

std::string multiplier_text(const PeriodicOrbit& orbit) {
  const std::complex<double> m = orbit.multipliers[0];
  if (m.imag() == 0.0) return fmt::format("{:.10g}", m.real());
  return fmt::format("{:.6f} + {:.6f} i", m.real(), m.imag());
}

// The columns with the words of the orbits as far as they fit, whole below each row if `verbose`;
// then which letter is which wall.
std::string with_words(std::vector<Column> columns, const OrbitWords& all, bool verbose) {
  const std::size_t rows = columns[0].cells.size();
  const std::size_t used = std::min(line_width, width_of(aligned(columns)) + 2);
  const std::size_t letters = std::max(least_letters, line_width - used);
  std::string legend;
  for (const auto& [letter, wall] : all.letters)
    legend += (legend.empty() ? "  " : ", ") + letter + " is " + wall;
  if (!legend.empty()) legend = folded(legend, "  ") + "\n";
  if (!verbose) {
    columns.push_back({"word", {}, true});
    for (std::size_t i = 0; i < rows; ++i) {
      const std::string& word = all.words[i];
      columns.back().cells.push_back(word.size() > letters ? word.substr(0, letters - 1) + "…"
                                                           : word);
    }
    return aligned(columns) + legend;
  }
  const std::vector<std::string> lines = lines_of(aligned(columns));
  const std::size_t head = lines.size() - rows;
  const std::string indent(8, ' ');
  std::string text;
  for (std::size_t i = 0; i < lines.size(); ++i)
    text += lines[i] + "\n" + (i < head ? "" : folded(indent + all.words[i - head], indent) + "\n");
  return text + legend;
}

}  // namespace

Json orbit_json(const System& system, const OrbitSearchResult& result,
                const OrbitContext& context) {
  Json json = Json::object();
  add_common_keys(json, system, result.threads, result.seconds, result.cpu_seconds);
  json.set("status", context.status);
  json.set("most_hits", context.most_hits);
  json.set("words", result.words).set("recurrences", result.recurrences);
  json.set("unsolved", result.unsolved).set("shadowed", result.shadowed);
  json.set("symmetries", result.symmetries).set("number", result.orbits.size());
  const OrbitWords names = words_of(result.orbits, *system.table);
  Json letters = Json::object();
  for (const auto& [letter, wall] : names.letters) letters.set(letter, wall);
  json.set("letters", std::move(letters));
  Json orbits = Json::array();
  for (std::size_t i = 0; i < result.orbits.size(); ++i) {
    Json one = one_json(*system.table, result.orbits[i], names.words[i]);
    if (i < context.proofs.orbits.size())
      one.set("certified", proof_json(context.proofs.orbits[i], context.proofs.digits));
    orbits.push(std::move(one));
  }
  if (result.cycles) json.set("zeta", zeta_json(*result.cycles));
  json.set("orbits", std::move(orbits));
  if (!context.output.empty()) json.set("archive", context.output);
  return json;
}

std::string orbit_text(const System& system, const OrbitSearchResult& result,
                       const OrbitContext& context) {
  const Table& table = *system.table;
  std::string text = heading(system);
  text += fmt::format("{} with at most {}{}\n", counted(result.orbits.size(), "periodic orbit"),
                      counted(context.most_hits, "hit"),
                      result.complete ? "" : "  (interrupted: from the starts tried so far)");
  std::vector<Column> columns{
      {"hits", {}}, {"period", {}}, {"multiplier", {}}, {"stability", {}, true}, {"copies", {}}};
  Column indices{"Maslov\nindex", {}};
  bool through_hole = false;
  for (const PeriodicOrbit& orbit : result.orbits) {
    through_hole = through_hole || std::any_of(orbit.hits.begin(), orbit.hits.end(),
                                               [](const OrbitHit& hit) { return hit.hole >= 0; });
    if (!context.verbose && columns[0].cells.size() == most_rows) continue;
    columns[0].cells.push_back(fmt::format("{}", orbit.hits.size()));
    columns[1].cells.push_back(fmt::format("{:.10g}", orbit.period));
    columns[2].cells.push_back(multiplier_text(orbit));
    columns[3].cells.push_back(std::string(name_of(orbit.stability)) +
                               (orbit.family ? ", family" : ""));
    indices.cells.push_back(orbit.maslov ? fmt::format("{}", *orbit.maslov) : "");
    columns[4].cells.push_back(orbit.family ? "" : fmt::format("{}", orbit.copies));
  }
  if (context.verbose) columns.push_back(indices);
  const std::size_t rows = columns[0].cells.size();
  if (rows > 0) text += "\n" + with_words(columns, words_of(result.orbits, table), context.verbose);
  if (rows < result.orbits.size())
    text += fmt::format("  of {}; --verbose prints all\n", grouped(result.orbits.size()));
  text += "\n";
  if (through_hole)
    text += "holes were closed: some orbits hit the wall in a hole (--json: hole)\n";
  std::string starts;
  if (result.words > 0) starts = counted(result.words, "word") + " of discs";
  if (result.recurrences > 0)
    starts += fmt::format("{}{} in random orbits", starts.empty() ? "" : " and ",
                          counted(result.recurrences, "recurrence"));
  text +=
      folded(fmt::format("searched from {}: {} led to no orbit, {} to an orbit that a wall blocks",
                         starts.empty() ? "nothing" : starts, grouped(result.unsolved),
                         grouped(result.shadowed))) +
      "\n";
  if (result.cycles) text += zeta_text(*result.cycles);
  if (!context.proofs.orbits.empty()) text += proofs_text(context.proofs);
  text +=
      fmt::format("{} of the table; {:.3g} s on {}\n",
                  counted(static_cast<std::uint64_t>(result.symmetries), "symmetry"),
                  result.seconds, counted(static_cast<std::uint64_t>(result.threads), "thread"));
  const bool proven = !context.proofs.orbits.empty(), all_words = result.recurrences == 0;
  text += grounds_text(
      proven ? "existence, in exact arithmetic" : "orbits close, no wall is in the way",
      all_words ? "longer orbits" : "whether orbits are missing");
  if (!context.output.empty()) text += fmt::format("archive: {}\n", context.output);
  return text;
}

OrbitContext OrbitsOutcome::context() const {
  return {most_hits, result.complete ? "completed" : "interrupted", "", false, proofs};
}

void OrbitsOutcome::save(const std::string& file, bool force, const std::atomic<bool>&) const {
  write_orbits(followed(file), loaded->loaded,
               provenance_of(loaded->options, system(), result.threads), result, proofs, most_hits,
               force);
}

OutcomePointer open_orbits(const std::string& file) {
  StoredOrbits stored = read_orbits(file);
  auto outcome = std::make_shared<OrbitsOutcome>(
      loaded_again("orbit", stored.system_toml, stored.system_name, file));
  outcome->most_hits = stored.most_hits;
  outcome->result = std::move(stored.result);
  outcome->proofs = std::move(stored.proofs);
  return outcome;
}

}  // namespace carom::cli
