#include "analyses/relax/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "cli/common.hpp"
#include "cli/reports/aligned.hpp"
#include "cli/reports/doubts.hpp"

namespace carom::cli {

using files::Json;

namespace {

constexpr std::size_t equilibria_shown = 12, modes_shown = 8;

/// Ten decimals, or as many as the error leaves.
std::string energy_text(const Equilibrium& e) {
  const double least = std::max(e.energy_error, 1e-13 * std::fabs(e.energy));
  return rounding_of(e.energy, least)(e.energy);
}

std::string modes_text(const Equilibrium& e, bool verbose) {
  if (e.modes.empty()) return "none: walls hold all";
  std::vector<std::string> words;
  for (const NormalMode& m : e.modes) {
    if (m.growth == 0.0 && m.frequency == 0.0)
      words.push_back("0");
    else if (m.growth == 0.0)
      words.push_back(fmt::format("{:.10g}", m.frequency));
    else if (m.frequency == 0.0)
      words.push_back(fmt::format("grows {:.10g}", m.growth));
    else
      words.push_back(fmt::format("{:.10g} grows {:.10g}", m.frequency, m.growth));
  }
  const std::size_t shown = verbose ? words.size() : std::min(words.size(), modes_shown);
  std::string text = fmt::format(
      "{}", fmt::join(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(shown), ", "));
  if (shown < words.size()) text += fmt::format(" and {} more", words.size() - shown);
  return text;
}

}  // namespace

const char* kind_of(const Equilibrium& e) {
  if (e.descending == 0) return "minimum";
  const int curved = static_cast<int>(e.modes.size()) - e.neutral;
  return e.descending == curved ? "maximum" : "saddle";
}

Json relax_json(const System& system, const RelaxResult& result, const std::string& output) {
  Json json = Json::object();
  add_common_keys(json, system, result.threads, result.seconds, result.cpu_seconds);
  json.set("status", result.complete ? "completed" : "interrupted");
  json.set("starts", result.starts);
  json.set("without", result.without);
  json.set("number", result.equilibria.size());
  Json equilibria = Json::array();
  for (const Equilibrium& e : result.equilibria) {
    Json positions = Json::array(), walls = Json::array(), frequencies = Json::array(),
         growths = Json::array();
    for (const auto& x : e.positions) positions.push(Json::array().push(x.x).push(x.y));
    for (const int wall : e.walls)
      walls.push(wall < 0 ? Json() : Json(system.table->wall(wall).name));
    for (const NormalMode& m : e.modes) {
      frequencies.push(m.frequency);
      growths.push(m.growth);
    }
    equilibria.push(Json::object()
                        .set("energy", e.energy)
                        .set("energy_error", e.energy_error)
                        .set("kind", kind_of(e))
                        .set("descending", e.descending)
                        .set("neutral", e.neutral)
                        .set("found", e.found)
                        .set("first", e.first)
                        .set("position_error", e.position_error)
                        .set("positions", std::move(positions))
                        .set("walls", std::move(walls))
                        .set("frequencies", std::move(frequencies))
                        .set("growths", std::move(growths)));
  }
  json.set("equilibria", std::move(equilibria));
  if (!output.empty()) json.set("archive", output);
  return json;
}

std::string relax_text(const System& system, const RelaxResult& result, const std::string& output,
                       bool verbose) {
  std::string text = heading(system);
  const std::size_t count = result.equilibria.size();
  text +=
      fmt::format("{} from {}{}\n", counted(count, "equilibrium"), counted(result.starts, "start"),
                  result.complete ? "" : "  (interrupted: from those followed so far)");
  if (result.without > 0)
    text += fmt::format("{} came to none\n", counted(result.without, "search"));
  const std::size_t shown = verbose ? count : std::min(count, equilibria_shown);
  if (shown > 0) {
    const auto n = static_cast<double>(system.particles.size());
    std::vector<Column> columns{
        {"energy", {}}, {"a particle", {}}, {"kind", {}, true}, {"found", {}}};
    for (std::size_t i = 0; i < shown; ++i) {
      const Equilibrium& e = result.equilibria[i];
      columns[0].cells.push_back(energy_text(e));
      columns[1].cells.push_back(fmt::format("{:.11g}", e.energy / n));
      columns[2].cells.push_back(
          e.minimum() ? kind_of(e) : fmt::format("{}, {} down", kind_of(e), e.descending));
      columns[3].cells.push_back(grouped(e.found));
    }
    if (n == 1) columns.erase(columns.begin() + 1);
    text += "\n" + fitted(columns);
    if (shown < count) text += fmt::format("  of {} equilibria\n", grouped(count));
    const Equilibrium& lowest = result.equilibria.front();
    text += "\nof the lowest\n" +
            folded("  modes      " + modes_text(lowest, verbose), "             ") + "\n";
    for (std::size_t i = 0; i < lowest.positions.size() && (verbose || i < equilibria_shown); ++i) {
      const int wall = lowest.walls[i];
      text += fmt::format("  {}{:.10g}, {:.10g}{}\n", i == 0 ? "positions  " : "           ",
                          lowest.positions[i].x, lowest.positions[i].y,
                          wall < 0 ? "" : " on '" + system.table->wall(wall).name + "'");
    }
  }
  text += fmt::format("\n{} in {:.3g} s on {}\n", counted(result.starts, "start"), result.seconds,
                      counted(static_cast<std::uint64_t>(result.threads), "thread"));
  text += grounds_text("forces vanish, signs of curvatures", "other equilibria (--starts)");
  if (!output.empty()) text += fmt::format("archive: {}\n", output);
  return text;
}

void RelaxOutcome::save(const std::string& file, bool force, const std::atomic<bool>&) const {
  write_equilibria(followed(file), loaded->loaded,
                   provenance_of(loaded->options, system(), result.threads), result, force);
}

OutcomePointer open_relax(const std::string& file) {
  StoredEquilibria stored = read_equilibria(file);
  auto outcome = std::make_shared<RelaxOutcome>(
      loaded_again("relax", stored.system_toml, stored.system_name, file));
  outcome->result = std::move(stored.result);
  return outcome;
}

}  // namespace carom::cli
