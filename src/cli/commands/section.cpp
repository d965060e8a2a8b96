// carom section: where orbits meet the walls, a line, a circle or a condition on the velocity.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>

#include "carom/ensemble/section_run.hpp"
#include "carom/ensemble/single_run.hpp"
#include "carom/events/world.hpp"
#include "cli/commands/commands.hpp"
#include "cli/commands/section.hpp"
#include "cli/common.hpp"
#include "cli/reports/aligned.hpp"
#include "cli/reports/doubts.hpp"
#include "cli/reports/section_report.hpp"
#include "io/progress.hpp"

namespace carom::cli {

namespace {

constexpr std::size_t orbits_shown = 12;

// A line of the printed table.
struct OrbitLine {
  std::uint64_t orbit = 0, points = 0;
  double from = 0, to = 0, last_time = 0;
};

void add(std::vector<OrbitLine>& lines, const std::vector<SectionPoint>& points) {
  for (const SectionPoint& p : points) {
    if (lines.empty() || lines.back().orbit != p.orbit) {
      if (lines.size() == orbits_shown) return;
      lines.push_back({p.orbit, 0, p.v_parallel, p.v_parallel, 0});
    }
    OrbitLine& line = lines.back();
    ++line.points;
    line.from = std::min(line.from, p.v_parallel);
    line.to = std::max(line.to, p.v_parallel);
    line.last_time = p.t;
  }
}

SystemOverrides section_overrides(const Options& options) {
  SystemOverrides overrides = options.overrides;
  const std::pair<const char*, const std::string*> keys[] = {
      {"section.on", &options.on},
      {"section.direction", &options.direction},
      {"section.points", &options.points},
      {"section.orbits", &options.orbits}};
  for (const auto& [key, text] : keys)
    if (!text->empty()) overrides.set.emplace_back(key, *text);
  if (options.orbits.empty() && !overrides.trajectories.empty())
    overrides.set.emplace_back("section.orbits", overrides.trajectories);
  return overrides;
}

std::string section_text(const System& system, const SectionResult& result,
                         const std::vector<OrbitLine>& lines, const std::string& output,
                         bool verbose) {
  std::string text = doubts_of(system, result).text() +
                     fmt::format("{}\n", system.title.empty() ? system.name : system.title);
  text += fmt::format("{} points of {} orbit{}{}\n", grouped(result.points), grouped(result.orbits),
                      result.orbits == 1 ? "" : "s",
                      result.complete ? "" : "  (interrupted: those that were finished)");
  if (!lines.empty()) {
    std::vector<Column> columns{{"orbit", {}}, {"points", {}}, {"last time", {}}};
    std::vector<std::string> from, to;
    for (const OrbitLine& line : lines) {
      columns[0].cells.push_back(fmt::format("{}", line.orbit));
      columns[1].cells.push_back(grouped(line.points));
      columns[2].cells.push_back(fmt::format("{:.6g}", line.last_time));
      from.push_back(fmt::format("{:+.4f}", line.from));
      to.push_back(fmt::format("{:+.4f}", line.to));
    }
    columns.push_back({"v_parallel", ranges(from, to), true});
    text += "\n" + aligned(columns);
    if (result.orbits > lines.size())
      text += fmt::format("  of {} orbits\n", grouped(result.orbits));
  }
  const std::string ends = fates_text(result);
  if (result.incomplete > 0)
    text += fmt::format("\n{} with fewer than {} points until t = {:.6g}{}\n",
                        grouped(result.incomplete), grouped(system.section.points),
                        system.run.t_max, ends.empty() ? "" : " (" + ends + ")");
  if (engine_of(system) != "events") text += "\n" + energy_text(system, result.energy_error);
  const std::string steps = steps_text(system, result.steps);
  text += fmt::format("\n{} collisions{}in {:.3g} s on {} thread{}: {}\n",
                      grouped(result.collisions), steps.empty() ? " " : "\n" + steps + "\n",
                      result.seconds, result.threads, result.threads == 1 ? "" : "s",
                      pace_text(system, result.collisions, result.steps, result.seconds));
  if (verbose)
    text += fmt::format("{}\ndigest {:016x}\n", decisions_text(result.decisions), result.digest);
  text += output.empty() ? "-o FILE.h5 stores the points\n" : fmt::format("archive: {}\n", output);
  return text;
}

}  // namespace

// Every hit is a point: orbits that are asked for a number of points have no last time. On one
// wall, on a line or at a velocity they may never have so many. Where the section is taken the
// command line or the file says.
LoadedSystem load_section(const Options& options, const Load& load) {
  SystemOverrides overrides = section_overrides(options);
  const bool last_time = !overrides.t_max.empty() ||
                         std::any_of(overrides.set.begin(), overrides.set.end(),
                                     [](const auto& one) { return one.first == "run.t_max"; });
  if (options.points.empty() || last_time) return load(overrides);
  LoadedSystem loaded = load(overrides);
  const SectionPlan& plan = loaded.system.section;
  if (!plan.boundary || plan.wall >= 0) return loaded;
  overrides.t_max = fmt::format("{}", no_last_time);
  return load(overrides);
}

int section(const Options& options) {
  check_engine(options);
  SectionOptions how;
  how.threads = threads_of(options);
  std::optional<io::Progress> preparing(std::in_place, !options.quiet);
  LoadedSystem loaded = load_section(options, [&](const SystemOverrides& overrides) {
    return load_system(options.system, overrides);
  });
  preparing.reset();
  choose_engine(options.engine, loaded.system);
  const System& system = loaded.system;

  how.interrupted = &catch_interrupts();  // before there is an archive
  std::unique_ptr<SectionArchive> archive;
  if (!options.output.empty())
    archive = std::make_unique<SectionArchive>(options.output, loaded,
                                               provenance_of(options, system, how.threads),
                                               options.force, lock_output(options.output));
  std::vector<OrbitLine> lines;
  how.points = [&](const std::vector<SectionPoint>& points) {
    if (archive) archive->append(points);
    add(lines, points);
  };
  SectionResult result;
  {
    io::Progress progress(!options.quiet);
    const double all = static_cast<double>(section_orbits(system));
    if (progress.enabled())
      how.progress = [&](std::uint64_t orbits, std::uint64_t points) {
        if (progress.due())
          progress.show(
              static_cast<double>(orbits) / all,
              io::with_prefix(static_cast<double>(points) / progress.seconds()) + "points/s");
      };
    result = run_section(system, how);
  }
  const std::string status = result.complete ? "completed" : "interrupted";
  if (archive) archive->finish(result, status);
  warn_of(result.reports);
  const std::string archive_name = named_archive(options, options.output);
  print(options.json ? section_json(system, result, status, archive_name).text() + "\n"
                     : section_text(system, result, lines, archive_name, options.verbose));
  return doubts_of(system, result).status(result.complete);
}

}  // namespace carom::cli
