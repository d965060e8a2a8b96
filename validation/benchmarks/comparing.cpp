// CPU time of a comparison of integrators, by evaluation of the force, beside the scheme's own run
// without questions: what measuring adds. The orders that it measures must be those of the schemes.
#include <carom/carom.hpp>
#include <cmath>
#include <string>

#include "measuring.hpp"
#include "table.hpp"

namespace carom::bench {

namespace {

struct Row {
  const char* name;
  const char* system;
  double t;
};
const Row rows[] = {{"comparison, Henon-Heiles", "henon-heiles", 20.0},
                    {"comparison, soft Lorentz gas", "soft-lorentz", 2.0}};

}  // namespace

void comparisons(Report& report) {
  for (const Row& row : rows) {
    if (!report.wants(row.name)) continue;
    const System system = load_system(row.system, {}).system;
    const ComparePlan plan{.schemes = {"velocity-verlet", "forest-ruth-4", "blanes-moan-srkn11b"},
                           .t_max = row.t};
    Comparison found;
    double runs = 0.0, evaluations = 0.0;
    Best best;
    best.repeat(3, [&] {
      found = compare(system, plan);
      runs = evaluations = 0.0;
      for (const ComparedScheme& scheme : found.schemes)
        for (const ComparedRun& run : scheme.runs) {
          if (run.failed()) continue;
          runs += run.cpu_seconds;
          evaluations += static_cast<double>(run.force_evaluations);
        }
      return evaluations;
    });
    bool right = true;
    for (const ComparedScheme& scheme : found.schemes)
      right = right && scheme.measured.slope &&
              std::abs(scheme.measured.slope->value - scheme.order) <
                  0.1 + 3 * scheme.measured.slope->error;
    report.add({row.name, "an evaluation", best.each, best.ratio, "the runs alone",
                1e9 * runs / evaluations / best.each, "orders 2, 4, 6", right});
  }
}

}  // namespace carom::bench
