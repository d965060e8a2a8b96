#include "cli/reports/section_report.hpp"

#include <fmt/format.h>

#include "cli/common.hpp"
#include "cli/reports/doubts.hpp"

namespace carom::cli {

using io::Json;

Json section_json(const System& system, const SectionResult& result, const std::string& status,
                  const std::string& output) {
  Json json = Json::object();
  add_common_keys(json, system, result.threads, result.seconds, result.cpu_seconds);
  json.set("status", status);
  json.set("points", result.points);
  json.set("orbits", result.orbits);
  json.set("incomplete", result.incomplete);
  add_fates(json, result);
  json.set("collisions", result.collisions);
  json.set("digest", fmt::format("{:016x}", result.digest));
  json.set("decisions", decisions_json(result.decisions));
  if (engine_of(system) != "events") json.set("energy_error", energy_json(result.energy_error));
  add_steps(json, system, result.steps);
  add_reports(json, result.reports);
  if (!output.empty()) json.set("archive", output);
  return json;
}

}  // namespace carom::cli
