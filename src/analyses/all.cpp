#include "carom/analyses/all.hpp"

#include <utility>

#include "carom/system/report_times.hpp"

namespace carom {

System make_system(const MadeTable& made, RunPlan run) {
  System system;
  system.table = made.table;
  system.particles = {Particle{}};
  if (!(run.t_max > 0.0))
    throw InputError(Place{"", 0, 0, "run.t_max"}, "must be positive", "a number > 0");
  if (run.times.empty()) run.times = default_report_times(run.t_max);
  system.run = std::move(run);
  return system;
}

SectionWithPoints section(const System& system, SectionOptions options) {
  SectionWithPoints result;
  const auto also = std::move(options.points);
  options.points = [&](const std::vector<SectionPoint>& points) {
    result.list.insert(result.list.end(), points.begin(), points.end());
    if (also) also(points);
  };
  static_cast<SectionResult&>(result) = run_section(system, options);
  return result;
}

}  // namespace carom
