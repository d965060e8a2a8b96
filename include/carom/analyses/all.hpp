// The analyses of the program as functions: a system first, then how to run it; results as values.
#pragma once

#include <vector>

#include "carom/analyses/diffusion.hpp"
#include "carom/analyses/escape.hpp"
#include "carom/analyses/run.hpp"
#include "carom/analyses/section.hpp"
#include "carom/system/system.hpp"
#include "carom/table/make.hpp"

namespace carom {

/// One particle of mass, charge and speed 1 on a table, without a field; starts are uniform.
/// RunPlan::times are those of the system file's default if none are given. Change what should
/// differ: system.particles, system.initial …
System make_system(const MadeTable&, RunPlan = {});

/// Survival and escapes of the ensemble.
inline EscapeResult escape(const System& system, const EscapeOptions& options = {}) {
  return run_escape(system, options);
}

/// Mean square displacements of the ensemble.
inline DiffusionResult diffusion(const System& system, const DiffusionOptions& options = {}) {
  return run_diffusion(system, options);
}

/// One trajectory, followed closely.
inline SingleRunResult run(const System& system, Observer& observer,
                           const SingleRunOptions& options = {}) {
  return run_single(system, observer, options);
}
inline SingleRunResult run(const System& system, const SingleRunOptions& options = {}) {
  Observer none;
  return run_single(system, none, options);
}

/// A section with its points, orbit after orbit.
struct SectionWithPoints : SectionResult {
  std::vector<SectionPoint> list;
};
/// Points of System::section; SectionOptions::points gets them as well, if set.
SectionWithPoints section(const System&, SectionOptions = {});

}  // namespace carom
