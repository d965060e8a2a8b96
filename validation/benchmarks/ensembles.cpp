// Whole ensembles, starts and sums included: lanes beside the scalar engine, and two threads beside
// one. Digests and what is added up must be equal, and the mean flight or the energy right.
#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <carom/carom.hpp>
#include <cmath>
#include <optional>
#include <string>

#include "measuring.hpp"
#include "table.hpp"

namespace carom::bench {

namespace {

double wall_seconds() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

System system_of(const char* name, double t_end, std::uint64_t trajectories) {
  System system = load_system(name).system;
  system.run.t_max = t_end;
  system.run.trajectories = trajectories;
  std::erase_if(system.run.times, [&](double t) { return t > t_end; });
  return system;
}

/// Digests, and what was added up beside them.
bool same_bits(const EscapeResult& a, const EscapeResult& b) {
  return a.digest == b.digest && a.counts.collisions == b.counts.collisions &&
         a.counts.gone_in == b.counts.gone_in;
}
bool same_bits(const DiffusionResult& a, const DiffusionResult& b) {
  bool same =
      a.digest == b.digest && a.collisions == b.collisions && a.energy_change == b.energy_change;
  for (std::size_t group = 0; group < DisplacementSums::groups; ++group)
    for (std::size_t k = 0; k < a.sums.times().size(); ++k) {
      const DisplacementSums::Sum &one = a.sums.of(group, k), &other = b.sums.of(group, k);
      same = same && one.count == other.count && one.square.value() == other.square.value() &&
             one.fourth.value() == other.fourth.value();
    }
  return same;
}

/// `run(lanes)` returns an ensemble's result, `events` how many it counts, `check` what its physics
/// says.
template <class Run, class Events, class Check>
void measure_row(Report& report, const std::string& what, int times, const Run& run,
                 const Events& events, const Check& check) {
  Best scalar, lanes;
  auto one = run(false), other = run(true);
  scalar.repeat(1, [&] { return events(one = run(false)); });
  lanes.repeat(times, [&] { return events(other = run(true)); });
  const auto [text, right] = check(other);
  const bool same = same_bits(one, other);
  report.add({what, name_of(widest_instruction_set()), lanes.each, lanes.ratio, "scalar",
              scalar.each / lanes.each,
              fmt::format("digests and sums {}, {}", same ? "equal" : "DIFFER", text),
              same && right});
}

struct Checked {
  std::string text;
  bool right;
};

void diffusion(Report& report, const char* name) {
  const System system = system_of(name, 100.0, 10'000);
  const auto run = [&](bool lanes) {
    DiffusionOptions how;
    how.threads = 1;
    how.lanes = lanes ? std::optional(widest_instruction_set()) : std::nullopt;
    return run_diffusion(system, how);
  };
  const auto events = [](const DiffusionResult& r) { return static_cast<double>(r.collisions); };
  measure_row(report, fmt::format("diffusion {}, a hit", name), 5, run, events,
              [&](const DiffusionResult& r) {
                const double expected = measure(*system.table).mean_flight;
                const double mean = system.run.times.back() * static_cast<double>(r.trajectories) /
                                    static_cast<double>(r.collisions);
                return Checked{fmt::format("mean flight {:.4f} of {:.4f}; {} report times", mean,
                                           expected, system.run.times.size()),
                               std::fabs(mean / expected - 1.0) < 0.01};
              });
}

// Figure 6 of Solanpaa et al. (2016), its beginning.
void soft_diffusion(Report& report) {
  const System system = system_of("soft-lorentz", 100.0, 1024);
  const auto run = [&](bool lanes) {
    DiffusionOptions how;
    how.threads = 1;
    how.lanes = lanes ? std::optional(widest_instruction_set()) : std::nullopt;
    return run_diffusion(system, how);
  };
  const auto steps = [&](const DiffusionResult& r) {
    return system.run.times.back() / system.dynamics.integrator.step *
           static_cast<double>(r.trajectories);
  };
  measure_row(report, "diffusion soft-lorentz, a step", 2, run, steps,
              [](const DiffusionResult& r) {
                return Checked{fmt::format("energy within {:.1e}", r.energy_change),
                               r.energy_change < 1e-6};
              });
}

EscapeResult escapes(const System& system, bool lanes, int threads) {
  EscapeOptions how;
  how.threads = threads;
  how.lanes = lanes ? std::optional(widest_instruction_set()) : std::nullopt;
  return run_escape(system, how);
}

bool same_bits(const LyapunovResult& a, const LyapunovResult& b) {
  const GrowthSums::Totals &x = a.growth.totals(), &y = b.growth.totals();
  return a.digest == b.digest && a.collisions == b.collisions &&
         x.growth.state() == y.growth.state() && x.hits.state() == y.hits.state();
}

// Deviations beside the same orbits without: the ratio of CPU times of two runs, one after the
// other. Other programs disturb both; the least of nine ratios is the best that is known.
void lyapunov(Report& report, const char* name) {
  System system = system_of(name, 1000.0, 4'000);
  auto table = std::make_shared<Table>(*system.table);
  table->holes.clear();
  for (Wall& wall : table->walls) wall.holes.clear();
  system.table = table;
  double ratio = 1e300, each = 1e300;
  LyapunovResult result;
  for (int pair = 0; pair < 9; ++pair) {
    const double begin = cpu_seconds();
    const EscapeResult plain = escapes(system, true, 1);
    const double middle = cpu_seconds();
    LyapunovOptions how;
    how.threads = 1;
    result = run_lyapunov(system, how);
    const double tangents = cpu_seconds() - middle;
    if (tangents / (middle - begin) < ratio) ratio = tangents / (middle - begin);
    each = std::min(each, tangents / static_cast<double>(plain.counts.collisions) * 1e9);
  }
  LyapunovOptions scalar;
  scalar.threads = 1;
  scalar.lanes = {};
  const bool same = same_bits(result, run_lyapunov(system, scalar));
  // Growth per time is that per hit over the mean flight pi A / L.
  const LyapunovEstimate e = estimate_of(result.growth);
  const double flights = e.per_time.value / e.per_hit.value * measure(*system.table).mean_flight;
  report.add({fmt::format("lyapunov {}, a hit", name), name_of(widest_instruction_set()), each, 0.0,
              "without deviations, about", 1.0 / ratio,
              fmt::format("bits of lanes and scalar {}, lambda {:.4f}, hits {:.4f} of L / pi A",
                          same ? "equal" : "DIFFER", e.per_time.value, flights),
              same && std::fabs(flights - 1.0) < 0.01});
}

void magnetic_square(Report& report) {
  const System system = system_of("magnetic-square", 100.0, 100'000);
  const auto events = [](const EscapeResult& r) {
    return static_cast<double>(r.counts.collisions);
  };
  const auto run = [&](bool lanes) { return escapes(system, lanes, 1); };
  measure_row(report, "escape magnetic-square, a hit", 5, run, events, [](const EscapeResult& r) {
    const double busy =
        1.0 - static_cast<double>(r.effort.idle) / static_cast<double>(r.effort.steps);
    return Checked{fmt::format("none lost, lanes {:.1f} % busy", 100.0 * busy), r.counts.lost == 0};
  });
}

// As pairs, for other programs may take a core meanwhile: the best of nine counts.
void two_threads(Report& report) {
  const System system = system_of("magnetic-square", 100.0, 400'000);
  double best = 0.0, cpu = 0.0, each = 1e300;
  bool same = true;
  for (int pair = 0; pair < 9; ++pair) {
    double wall[2], work[2];
    EscapeResult results[2];
    for (const int threads : {1, 2}) {
      const auto i = static_cast<std::size_t>(threads - 1);
      const double start = wall_seconds(), begin = cpu_seconds();
      results[i] = escapes(system, true, threads);
      wall[i] = wall_seconds() - start;
      work[i] = cpu_seconds() - begin;
    }
    same = same && same_bits(results[0], results[1]);
    if (wall[0] / wall[1] > best) best = wall[0] / wall[1], cpu = work[1] / work[0];
    each = std::min(each, wall[1] / static_cast<double>(results[1].counts.collisions) * 1e9);
  }
  report.add({"two threads, a hit, wall time", name_of(widest_instruction_set()), each,
              each / chain(), "one thread", best,
              fmt::format("digests and sums {}, CPU time {:.3f} of one thread's",
                          same ? "equal" : "DIFFER", cpu),
              same});
}

}  // namespace

void whole_ensembles(Report& report) {
  for (const char* name : {"lorentz-triangular", "lorentz-square", "sinai"})
    if (report.wants(fmt::format("diffusion {}", name))) diffusion(report, name);
  if (report.wants("diffusion soft-lorentz")) soft_diffusion(report);
  if (report.wants("escape magnetic-square")) magnetic_square(report);
  for (const char* name : {"stadium", "lorentz-triangular"})
    if (report.wants(fmt::format("lyapunov {}", name))) lyapunov(report, name);
  if (report.wants("two threads")) two_threads(report);
}

}  // namespace carom::bench
