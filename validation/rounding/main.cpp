// Does rounding bias survival? Flies the first trajectories of an ensemble in doubles and
// certified, from the same starts, and tests whether their survival curves differ: rounding SYSTEM
// PAIRS TIMES, as in
//
//     rounding stadium 1e5 10,50,100,200
//
// Exit status 1 where they differ (p < .001) or a pair was lost.
// docs/physics/rounding-and-statistics.md
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <optional>
#include <string>

#include "analyses/run/command_certified.hpp"
#include "carom/analyses/run.hpp"
#include "carom/base/error.hpp"
#include "carom/base/exact_number.hpp"
#include "carom/certify/certified_orbit.hpp"
#include "carom/files/system_file.hpp"
#include "carom/starts/sampler.hpp"
#include "validation/rounding/paired_escape.hpp"

namespace carom::rounding {
namespace {

OtherFlight certified_flight(const LoadedSystem& loaded) {
  ExactSystem system = loaded.exact;
  CertifiedTask task;
  task.collisions = loaded.system.run.collisions;
  if (loaded.system.run.t_max < no_last_time) task.t_max = ExactNumber(loaded.t_max);
  task.digits = 10;
  task.most_bits = 200'000;
  return [system, task](const State& start) mutable -> OtherEnd {
    // A start that was drawn is its doubles, taken exactly; the direction's length is free.
    system.start = cli::exact_start(start);
    std::optional<CertifiedOrbit> orbit;
    try {
      orbit.emplace(system, task);
    } catch (const InputError&) {  // next to a wall, and outside of the table as it was written
      return {};
    }
    const CertifiedEnd& end = orbit->finish();
    OtherEnd result{OtherEnd::known, {}};
    result.end.hits = end.collisions;
    result.end.hole = end.hole;
    switch (end.fate) {
      case CertifiedFate::completed:
      case CertifiedFate::pinned:
        return result;
      case CertifiedFate::escaped:
      case CertifiedFate::unbounded:
        result.end.time = end.t.to_double();
        return result;
      case CertifiedFate::singular:
        return {OtherEnd::singular, {}};
      default:
        return {};
    }
  };
}

int compare(const std::string& name, const std::string& pairs, const std::string& times) {
  SystemOverrides overrides;
  overrides.trajectories = pairs;
  overrides.times = times;
  const LoadedSystem loaded = load_system(name, overrides);
  PairedEscapeOptions how;
  how.sample = loaded.system.run.trajectories;
  const PairedEscapeResult all = compare_escapes(
      loaded.system, [&] { return certified_flight(loaded); }, how);
  const PairedResult& r = all.pairs;
  fmt::print("{} pairs: {} escape elsewhere or not, {} after other hits, {} at another time\n",
             r.pairs, r.other_hole, r.other_hits, r.other_time);
  fmt::print("not compared: {} singular in doubles, {} certified as singular, {} undecided\n",
             all.singular, all.other_singular, all.unknown);
  fmt::print("{:>10} {:>10} {:>10} {:>10} {:>10} {:>10}\n", "t", "double", "certified",
             "difference", "error", "detectable");
  for (const PairedPoint& p : r.points)
    fmt::print("{:>10} {:>10.6f} {:>10.6f} {:>+10.6f} {:>10.6f} {:>10.6f}\n", p.t, p.first,
               p.second, p.difference, p.error, p.detectable);
  fmt::print(
      "largest difference {:.2f} standard errors; {} random swaps exceed {:.2f} in 5 %: p = "
      "{:.4f}\n",
      r.statistic, r.swaps, r.threshold, r.p_value);
  return r.p_value < 0.001 || all.lost + all.unresolved > 0 ? 1 : 0;
}

}  // namespace
}  // namespace carom::rounding

int main(int count, char** words) {
  if (count != 4) {
    fmt::print(stderr, "rounding SYSTEM PAIRS TIMES\n");
    return 2;
  }
  try {
    return carom::rounding::compare(words[1], words[2], words[3]);
  } catch (const std::exception& error) {
    fmt::print(stderr, "rounding: {}\n", error.what());
    return 1;
  }
}
