#include "analyses/lyapunov/report_parts.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "carom/starts/sampler.hpp"
#include "carom/starts/start_measure.hpp"
#include "cli/common.hpp"
#include "cli/loading.hpp"
#include "cli/reports/aligned.hpp"

namespace carom::cli {

using files::Json;

namespace {

// Archives of older versions, which keep no drift, hold orbits from the walls.
bool were_drawn(const System& system, const LyapunovResult& result) {
  return starts_of_the_map(system) && result.drift.orbits > 0;
}

// Of an exponent of orbits that all count in the sums.
std::optional<Drift> drift_of_window(const LyapunovResult& result, const DriftSums& sums,
                                     const Estimate& exponent) {
  if (sums.orbits != result.growth.totals().orbits) return std::nullopt;
  return drift_of(sums, result.growth.window(), exponent);
}

Json drift_json(const std::optional<Drift>& drift) {
  if (!drift) return {};
  const auto json = [](const Estimate& e) {
    return Json::object().set("value", e.value).set("stderr", e.error);
  };
  return Json::object()
      .set("fast", json(drift->fast))
      .set("slow", json(drift->slow))
      .set("seen", drift->seen);
}

// Would uniform starts be stationary?
bool may_be_uniform(System system) {
  system.initial.kind = InitialCondition::Kind::uniform;
  return system.table->extent != Extent::open_plane && why_not_stationary(system).empty();
}

Estimate entropy_of(const LyapunovResult& result) { return estimate_of(result.spectrum).entropy; }

}  // namespace

void add_starts(Json& json, const System& system, const LyapunovResult& result,
                const LyapunovEstimate& e) {
  const bool other = were_drawn(system, result);
  Json starts = starts_json(other ? with_starts_of_the_flow(system) : system);
  if (other) starts.set("drawn", drawn_in_place(system));
  json.set("starts", std::move(starts));
  json.set("drift", drift_json(drift_of_window(result, result.drift, e.per_time)));
  if (result.spectrum.counted())
    json.set("entropy_drift",
             drift_json(drift_of_window(result, result.entropy_drift, entropy_of(result))));
}

std::string drawn_text(const System& system, const LyapunovResult& result) {
  return were_drawn(system, result)
             ? folded(fmt::format("starts: {}", drawn_in_place(system))) + '\n'
             : "";
}

std::uint64_t uncounted(const System& system, const LyapunovResult& result) {
  return starts_of_the_map(system) ? result.pinned : 0;
}

std::vector<std::string> drift_notes(const System& system, const LyapunovResult& result,
                                     const LyapunovEstimate& e) {
  const std::string why = why_not_stationary(with_starts_of_the_flow(system));
  // Where deviations grow linearly no exponent could drift, and repeated starts have no errors.
  if (why.empty() || result.repeller || e.law != LyapunovEstimate::Law::exponential ||
      !repeated_starts(system).empty())
    return {};
  std::vector<std::string> notes;
  const auto add = [&](const char* what, const DriftSums& sums, const Estimate& exponent) {
    const auto drift = drift_of_window(result, sums, exponent);
    if (!drift || !drift->seen) return;
    const double least = std::fabs(drift->fast.value), most = std::fabs(drift->slow.value);
    notes.push_back(fmt::format(
        "the starts are not stationary ({}), and {} still drifts: it is too {} by some {:.2g} if "
        "that falls as 1/t, {:.2g} if as 1/sqrt(t). {}",
        why, what, drift->fast.value > 0.0 ? "large" : "small", least, most,
        may_be_uniform(system) ? "Uniform starts (initial.kind = \"uniform\") do not drift"
                               : "A longer run drifts less"));
  };
  add("lambda", result.drift, e.per_time);
  if (result.spectrum.counted()) add("the entropy", result.entropy_drift, entropy_of(result));
  return notes;
}

}  // namespace carom::cli
