#include "cli/reports/doubts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>

#include "carom/events/report.hpp"
#include "carom/integrators/scheme.hpp"
#include "carom/results/ensemble_result.hpp"
#include "cli/common.hpp"
#include "cli/loading.hpp"
#include "cli/reports/aligned.hpp"
#include "files/progress.hpp"

namespace carom::cli {

using files::Json;

namespace {

bool integrated(const System& system) { return engine_of(system) != "events"; }

std::string lost_text(std::uint64_t lost, const std::string& of) {
  return fmt::format("internal error, please report it: {} {} lost", of, lost == 1 ? "is" : "are");
}

Reports reports_of(const SingleRunResult& r) {
  Reports reports;
  for (std::size_t p = 0; p < r.particles.size(); ++p) {
    const RunEnd& end = r.particles[p];
    if (is_failure(end.progress.fate) && !end.report.empty()) reports.emplace_back(p, end.report);
  }
  return reports;
}

}  // namespace

std::string Doubts::text() const {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

std::string Doubts::folded_text() const {
  std::string text;
  for (const std::string& line : lines) text += folded(line) + "\n";
  return text;
}

int Doubts::status(bool complete) const { return any() ? untrusted : complete ? done : stopped; }

std::string energy_doubt(const System& system, const EnergyError& error) {
  const IntegratorPlan& plan = system.dynamics.integrator;
  if (!integrated(system) || error.largest <= plan.energy_tolerance) return {};
  return fmt::format(
      "the energy changed by {:.2g} of the largest kinetic energy, more than "
      "integrator.energy_tolerance = {}: take a {}",
      error.largest, plan.energy_tolerance,
      is_adaptive(plan.scheme) ? "smaller tolerance" : "shorter step");
}

Doubts doubts_of(const System& system, std::uint64_t all, const char* what, const FateCounts& fates,
                 const Reports& reports, const EnergyError& energy) {
  Doubts doubts{{}, fates.unresolved + fates.lost};
  if (fates.lost > 0)
    doubts.lines.push_back(
        lost_text(fates.lost, fmt::format("{} of {}", grouped(fates.lost), counted(all, what))));
  if (doubts.failed > 0 && !reports.empty()) {
    const auto& [index, report] = reports.front();
    const std::string others =
        all > 1 ? fmt::format(" ({} {}, the first of {} of {} that could not be followed)", what,
                              index, grouped(doubts.failed), grouped(all))
                : "";
    doubts.lines.push_back(std::string(shown(report)) + others);
  } else if (fates.unresolved > 0) {
    doubts.lines.push_back(fmt::format("{} of {} could not be followed", grouped(fates.unresolved),
                                       counted(all, what)));
  }
  if (std::string doubt = energy_doubt(system, energy); !doubt.empty())
    doubts.lines.push_back(std::move(doubt));
  return doubts;
}

Doubts doubts_of(const System& system, const SectionResult& r) {
  return doubts_of(system, r.orbits * system.particles.size(), "particle", r, r.reports,
                   r.energy_error);
}
Doubts doubts_of(const System& system, const SingleRunResult& r) {
  FateCounts fates;
  EnergyError energy;
  for (const RunEnd& end : r.particles) {
    fates.count(end.progress.fate);
    energy += end.energy_error;
  }
  return doubts_of(system, r.particles.size(), "particle", fates, reports_of(r), energy);
}

Doubts doubts_of_failures(std::uint64_t unresolved, std::uint64_t lost) {
  Doubts doubts{{}, unresolved + lost};
  if (lost > 0) doubts.lines.push_back(lost_text(lost, counted(lost, "trajectory")));
  if (unresolved > 0)
    doubts.lines.push_back(
        fmt::format("{} could not be followed", counted(unresolved, "trajectory")));
  return doubts;
}

std::string fates_text(const FateCounts& counts) {
  std::string text;
  const auto add = [&](std::uint64_t number, const std::string& what) {
    if (number > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", grouped(number), what);
  };
  add(counts.pinned, "pinned on cyclotron orbits that never hit");
  add(counts.escaped - counts.unbounded, "escaped");
  add(counts.capped, "ended by the cap on hits");
  add(counts.unbounded, "escaped to infinity");
  add(counts.singular, "singular");
  add(counts.unresolved, "unresolved: integration could not follow: see the messages");
  add(counts.lost, "lost: an internal error: please report it");
  return text;
}

void add_report(Json& json, const std::string& report) {
  json.set("reason", shown(report)).set("state", bits_in(report));
}

void add_reports(Json& json, const Reports& reports) {
  if (reports.empty()) return;
  Json list = Json::array();
  for (const auto& [index, report] : reports) {
    Json one = Json::object().set("index", index);
    add_report(one, report);
    list.push(std::move(one));
  }
  json.set("reports", std::move(list));
}

void warn_of(const Reports& reports, std::uint64_t all) {
  constexpr std::size_t most = 3;
  std::set<std::string_view> said;  // reason and time: a group fails at once
  const std::string mark = "carom: ";
  for (const auto& [index, report] : reports) {
    if (said.size() == most) break;
    const std::string_view text = shown(report);
    if (said.insert(text.substr(0, text.rfind(", x = "))).second)
      warn(folded(mark + std::string(text), "  ").substr(mark.size()));
  }
  if (all > said.size())
    warn(fmt::format("{} more could not be followed; --json has the {}of {}",
                     grouped(all - said.size()),
                     all > reports.size() ? "first states, " : "states ", grouped(reports.size())));
}

void warn_of(const SingleRunResult& result) {
  const Reports reports = reports_of(result);
  warn_of(reports, reports.size());
}

void add_steps(Json& json, const System& system, const StepCounts& steps) {
  if (!integrated(system)) return;
  const IntegratorPlan& plan = system.dynamics.integrator;
  json.set("step", plan.step > 0.0 ? Json(plan.step) : Json());
  if (plan.step_chosen) json.set("step_chosen", true);
  json.set("steps", steps.steps).set("force_evaluations", steps.force_evaluations);
  if (plan.halve_unresolved) {
    json.set("halved_steps", steps.halved);
    json.set("shortest_step", steps.halved > 0 ? Json(steps.shortest_part) : Json());
  }
  if (!plan.count_unresolved) return;
  json.set("unresolved_steps", steps.unresolved);
  json.set("first_unresolved", steps.unresolved > 0 ? Json(steps.first_unresolved) : Json());
}

std::string steps_text(const System& system, const StepCounts& steps) {
  if (!integrated(system)) return {};
  const IntegratorPlan& plan = system.dynamics.integrator;
  std::string text = counted(steps.steps, "step");
  if (plan.step > 0.0)
    text += fmt::format(" of {}{}", plan.step, plan.step_chosen ? " (chosen)" : "");
  if (steps.halved > 0)
    text += fmt::format(", {} of them of {:.3g} or more, as longer ones do not resolve the forces",
                        grouped(steps.halved), steps.shortest_part);
  text += ", " + counted(steps.force_evaluations, "force evaluation");
  if (system.dynamics.integrator.count_unresolved)
    text += steps.unresolved == 0
                ? std::string(", no step unresolved")
                : fmt::format(", {} unresolved, the first at t = {:.6g}",
                              counted(steps.unresolved, "step"), steps.first_unresolved);
  return text;
}

std::string pace_text(const System& system, const EventCounts& events, const StepCounts& steps,
                      double seconds) {
  const bool by_steps = events.all() == 0 && integrated(system);
  const char* const unit = by_steps               ? "steps/s"
                           : events.contacts == 0 ? "hits/s"
                           : events.hits == 0     ? "contacts/s"
                                                  : "hits and contacts/s";
  return files::with_prefix(static_cast<double>(by_steps ? steps.steps : events.all()) /
                            std::max(seconds, 1e-9)) +
         unit;
}

std::string energy_text(const System& system, const EnergyError& error) {
  if (!integrated(system)) return {};
  return fmt::format(
      "largest change of a trajectory's energy, over its largest kinetic energy:\n"
      "{:.2g} at the end, {:.2g} at most\n",
      error.end, error.largest);
}

std::string grounds_text(const std::string& checked, const std::string& unchecked) {
  return folded("checked: " + checked + "; not: " + unchecked) + "\n";
}

std::string grounds_text(const System& system, const StepCounts& steps, bool errors) {
  const bool integrated = engine_of(system) != "events";
  std::string checked = integrated ? "energy" : "walls (exact signs)";
  if (integrated && steps.unresolved == 0) checked += ", steps";
  if (errors) checked += ", errors (docs/physics/errors.md)";
  return grounds_text(checked, integrated ? "half the step" : "rounding");
}

}  // namespace carom::cli
