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

std::string correlation_note(const System& system) {
  const std::string why = why_not_stationary(system);
  if (why.empty()) return {};
  return fmt::format(
      "the starts are not stationary ({}): C(t) and its integral are those from these starts, and "
      "D(t) need not tend to D{}",
      why, system.run.free_paths ? "; free paths are biased by a part that falls as 1/t" : "");
}

}  // namespace carom::cli
