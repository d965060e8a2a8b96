// carom section: where orbits meet the walls, a line, a circle or a condition on the velocity.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "analyses/section/report.hpp"
#include "carom/analyses/section.hpp"
#include "carom/events/world.hpp"
#include "cli/commands/commands.hpp"
#include "cli/commands/own_step.hpp"
#include "cli/common.hpp"
#include "cli/loading.hpp"
#include "cli/reports/doubts.hpp"
#include "cli/signals.hpp"
#include "files/progress.hpp"

namespace carom::cli {

namespace {

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

// Every hit is a point: orbits that are asked for a number of points have no last time. On one
// wall, on a line or at a velocity they may never have that many. Where the section is taken the
// command line or the file says.
LoadedSystem load_section(const Options& options) {
  SystemOverrides overrides = section_overrides(options);
  const bool last_time = !overrides.t_max.empty() ||
                         std::any_of(overrides.set.begin(), overrides.set.end(),
                                     [](const auto& one) { return one.first == "run.t_max"; });
  if (options.points.empty() || last_time) return load(options, overrides);
  LoadedSystem loaded = load(options, overrides);
  const SectionPlan& plan = loaded.system.section;
  if (!plan.boundary || plan.wall >= 0) return loaded;
  overrides.t_max = fmt::format("{}", no_last_time);
  return load(options, overrides);
}

}  // namespace

LoadedSystem system_of_section(const Options& options) {
  LoadedSystem loaded = load_section(options);
  choose_engine(options.engine, loaded.system);
  return loaded;
}

int section(const Options& options) {
  check_engine(options);
  SectionOptions how;
  how.threads = threads_of(options);
  std::optional<files::Progress> preparing(std::in_place, !options.quiet);
  LoadedSystem loaded = system_of_section(options);
  preparing.reset();
  const System& system = loaded.system;

  how.interrupted = &catch_interrupts();  // before there is an archive
  ArchiveLock lock;
  if (!options.output.empty()) lock = lock_output(options, options.output);
  std::unique_ptr<SectionArchive> archive;
  const auto begin_archive = [&] {
    if (!options.output.empty())
      archive = std::make_unique<SectionArchive>(
          options.output, loaded, provenance_of(options, system, how.threads), options.force, lock);
  };
  begin_archive();
  OrbitLines lines;
  how.points = [&](const std::vector<SectionPoint>& points) {
    if (archive) archive->append(points);
    lines.add(points);
  };
  OwnStep own_step(options);
  SectionResult result;
  for (;;) {
    files::Progress progress(!options.quiet);
    const double all = static_cast<double>(section_orbits(system));
    if (progress.enabled())
      how.progress = [&](std::uint64_t orbits, std::uint64_t points) {
        if (progress.due())
          progress.show(
              static_cast<double>(orbits) / all,
              files::with_prefix(static_cast<double>(points) / progress.seconds()) + "points/s");
      };
    result = run_section(system, how);
    if (!result.complete || !own_step.halve(loaded, result.energy_error)) break;
    lines = {};
    archive.reset();
    begin_archive();
  }
  const std::string status = result.complete ? "completed" : "interrupted";
  if (archive) archive->finish(result, status);
  const std::string archive_name = named_archive(options, options.output);
  const Doubts doubts = doubts_of(system, result);
  warn_of(result.reports, doubts.failed);
  print_report(
      options,
      [&] { return own_step.with_halvings(section_json(system, result, status, archive_name)); },
      [&] {
        return section_text(system, result, lines, archive_name, options.verbose) +
               own_step.text() + (archive ? "" : "-o FILE.h5 stores the points\n");
      },
      doubts.text());
  return doubts.status(result.complete);
}

}  // namespace carom::cli
