#include "cli/reports/starts_report.hpp"

#include <fmt/format.h>

#include "carom/starts/start_measure.hpp"

namespace carom::cli {

using files::Json;

Json starts_json(const System& system) {
  const std::string why = why_not_stationary(system);
  Json json = Json::object().set("stationary", why.empty());
  if (!why.empty()) json.set("reason", why);
  return json;
}

std::string drawn_in_place(const System& system) {
  std::string text =
      "uniform, the measure of the flow, in place of starts from all walls, which have that of the "
      "map from hit to hit";
  for (const Particle& p : system.particles)
    if (p.omega != 0.0) return text + "; circles that meet no wall do not count";
  return text;
}

std::string correlation_note(const System& system) {
  const std::string why = why_not_stationary(system);
  if (why.empty()) return {};
  return fmt::format(
      "the starts are not stationary ({}): C(t) and its integral are those from these starts, and "
      "D(t) need not tend to D{}",
      why, system.run.free_paths ? "; free paths are biased by a part that falls as 1/t" : "");
}

}  // namespace carom::cli
