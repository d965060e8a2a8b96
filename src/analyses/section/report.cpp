#include "analyses/section/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "cli/common.hpp"
#include "cli/loading.hpp"
#include "cli/reports/aligned.hpp"
#include "cli/reports/doubts.hpp"
#include "files/describe/json_out.hpp"

namespace carom::cli {

using files::Json;

namespace {

constexpr std::size_t orbits_shown = 12;

}  // namespace

void OrbitLines::add(const std::vector<SectionPoint>& points) {
  for (const SectionPoint& p : points) {
    if (lines_.empty() || lines_.back().orbit != p.orbit) {
      if (lines_.size() == orbits_shown) return;
      lines_.push_back({p.orbit, 0, p.v_parallel, p.v_parallel, 0});
    }
    Line& line = lines_.back();
    ++line.points;
    line.from = std::min(line.from, p.v_parallel);
    line.to = std::max(line.to, p.v_parallel);
    line.last_time = p.t;
  }
}

std::string OrbitLines::table() const {
  std::vector<Column> columns{{"orbit", {}}, {"points", {}}, {"last time", {}}};
  std::vector<std::string> from, to;
  for (const Line& line : lines_) {
    columns[0].cells.push_back(fmt::format("{}", line.orbit));
    columns[1].cells.push_back(grouped(line.points));
    columns[2].cells.push_back(fmt::format("{:.6g}", line.last_time));
    from.push_back(fmt::format("{:+.4f}", line.from));
    to.push_back(fmt::format("{:+.4f}", line.to));
  }
  columns.push_back({"v_parallel", ranges(from, to), true});
  return fitted(columns);
}

Json section_json(const System& system, const SectionResult& result, const std::string& status,
                  const std::string& output) {
  Json json = Json::object();
  add_common_keys(json, system, result.threads, result.seconds, result.cpu_seconds);
  json.set("status", status);
  files::add_numbers(json, result);
  files::add_numbers<FateCounts>(json, result);
  json.set("decisions", decisions_json(result.decisions));
  if (system.is_integrated()) files::add_numbers(json, result.energy_error);
  add_steps(json, system, result.steps);
  add_reports(json, result.reports);
  if (!output.empty()) json.set("archive", output);
  return json;
}

std::string section_text(const System& system, const SectionResult& result, const OrbitLines& lines,
                         const std::string& output, bool verbose) {
  std::string text = doubts_of(system, result).folded_text() + heading(system);
  text +=
      fmt::format("{} of {}{}\n", counted(result.points, "point"), counted(result.orbits, "orbit"),
                  result.complete ? "" : "  (interrupted: only the finished ones)");
  if (!lines.empty()) {
    text += "\n" + lines.table();
    if (result.orbits > lines.size())
      text += fmt::format("  the first {} of {}\n", lines.size(), counted(result.orbits, "orbit"));
  }
  const std::string ends = fates_text(result);
  if (result.incomplete > 0)
    text += "\n" +
            folded(fmt::format("{} with fewer than {} {}{}", grouped(result.incomplete),
                               counted(system.section.points, "point"), until(system.run.t_max),
                               ends.empty() ? "" : " (" + ends + ")")) +
            "\n";
  if (engine_of(system) != "events") text += "\n" + energy_text(system, result.energy_error);
  const std::string steps = steps_text(system, result.steps);
  text += fmt::format("\n{}{}in {:.3g} s on {}: {}\n", counted(result.collisions, "collision"),
                      steps.empty() ? " " : "\n" + steps + "\n", result.seconds,
                      counted(static_cast<std::uint64_t>(result.threads), "thread"),
                      pace_text(system, {result.collisions}, result.steps, result.seconds));
  if (verbose)
    text += fmt::format("{}\ndigest {:016x}\n", decisions_text(result.decisions), result.digest);
  text += grounds_text(system, result.steps, false);
  return output.empty() ? text : text + fmt::format("archive: {}\n", output);
}

std::string SectionOutcome::text() const {
  OrbitLines lines;
  lines.add(*points);
  return section_text(system(), result, lines, "");
}

std::vector<std::string> SectionOutcome::doubts() const {
  return doubts_of(system(), result).lines;
}

void SectionOutcome::save(const std::string& file, bool force, const std::atomic<bool>&) const {
  SectionArchive archive(followed(file), loaded->loaded,
                         provenance_of(loaded->options, system(), result.threads), force);
  archive.append(*points);
  archive.finish(result, status());
}

OutcomePointer open_section(const std::string& file) {
  StoredSection stored = read_section(file);
  auto outcome = std::make_shared<SectionOutcome>(
      loaded_again("section", stored.system_toml, stored.system_name, file, stored.engine));
  outcome->result = stored.result;
  *outcome->points = std::move(stored.points);
  return outcome;
}

}  // namespace carom::cli
