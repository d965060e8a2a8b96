#include "carom/analyses/returns.hpp"

#include <algorithm>
#include <cmath>

#include "carom/base/error.hpp"
#include "carom/events/energy.hpp"
#include "carom/starts/sampler.hpp"
#include "carom/starts/start_measure.hpp"
#include "engines/energy_watch.hpp"
#include "engines/ensemble_run.hpp"
#include "results/distribution.hpp"

namespace carom {

namespace analyses {

namespace {

/// The excursions of one particle, as they come.
class Excursions {
 public:
  void hit(const Time& time, std::uint64_t hits, bool at_wall, double half) {
    const bool early = !(time > Time(half));
    if (early) ++sum_.hits_in_half;
    if (!at_wall) return;
    if (away_) {
      sum_.times.add(time - left_, half);
      sum_.hits.bins.add(static_cast<double>(hits - hits_));
    }
    away_ = early;
    left_ = time;
    hits_ = hits;
  }
  /// `hits`: of the particle at the end of the run.
  ReturnSums::Sum end(std::uint64_t hits) {
    sum_.particles = 1;
    if (away_) {
      ++sum_.times.longer;
      ++sum_.hits.longer;
      sum_.fewest_away = hits - hits_;
    }
    return std::move(sum_);
  }

 private:
  ReturnSums::Sum sum_;
  Time left_;
  std::uint64_t hits_ = 0;
  bool away_ = false;  ///< in an excursion that counts
};

class ReturnsListener : public engines::EnsembleListener<ReturnsResult> {
 public:
  ReturnsListener(const System& system, const Engine& engine, Thread& thread)
      : EnsembleListener(system, engine, thread), half_(system.run.t_max / 2) {}

  void begin(const Trajectory& t) override {
    if (under_way_.size() <= t.slot)
      under_way_.resize(t.slot + 1,
                        {{}, engines::EnergyWatch(system_, [this] { return thread_.stopped(); })});
    under_way_[t.slot].excursions.assign(t.starts.size(), {});
    under_way_[t.slot].energies.begin(t);
  }
  void hit(const Trajectory& t, int particle, const State& state, std::uint64_t hits) override {
    under_way_[t.slot].excursions[static_cast<std::size_t>(particle)].hit(
        state.time, hits, state.wall == system_.section.wall, half_);
  }
  void end(const Trajectory& t, const TrajectoryEnd& end) override {
    UnderWay& mine = under_way_[t.slot];
    const engines::EnergiesSeen energies = mine.energies.end(t, end);
    const TrajectoryRange range{t.number, t.number + 1};
    std::uint64_t hits = 0;
    thread_.deliver(range, [&](ReturnsResult& sum) {
      for (std::size_t p = 0; p < end.particles.size(); ++p) {
        const ParticleEnd& particle = end.particles[p];
        sum.add_end(particle.fate, particle.hits);
        hits += particle.hits;
        // One that ends early was not seen long enough.
        if (particle.fate == Fate::survived || particle.fate == Fate::pinned)
          sum.sums.add(t.number % ReturnSums::groups, mine.excursions[p].end(particle.hits));
        const std::uint64_t index = index_of(t, p);
        add_end(sum, index, particle.fate, particle.report,
                hash_(index, particle.fate, particle.time, particle.hits, particle.last_wall,
                      particle.state));
      }
      add_end(sum, sum.contacts, end, energies.error);
      add_done(sum, range);
    });
    thread_.report(1, hits);
  }

 private:
  struct UnderWay {
    std::vector<Excursions> excursions;  ///< of each particle
    engines::EnergyWatch energies;
  };
  double half_;
  std::vector<UnderWay> under_way_;  ///< by slot
};

void refuse_impossible(const System& system) {
  const SectionPlan& plan = system.section;
  const Table& table = *system.table;
  if (!table.regions.empty())
    throw InputError(Place{"", 0, 0, "table.region"},
                     "the expected time of returns knows no regions", "no [[table.region]]");
  if (!plan.boundary || plan.wall < 0)
    throw InputError(Place{"", 0, 0, "section.on"}, "returns are to a wall, and none is named",
                     "wall:NAME; carom table lists the walls");
  if (table.extent == Extent::open_plane ||
      std::any_of(table.walls.begin(), table.walls.end(),
                  [](const Wall& wall) { return !wall.holes.empty(); }))
    throw InputError(Place{"", 0, 0, "table"}, "orbits that leave do not return",
                     "a table without holes; --closed shuts them");
  if (system.run.collisions > 0)
    throw InputError(Place{"", 0, 0, "run.collisions"}, "a limit on hits cuts excursions off",
                     "a time alone, --t-max");
  refuse_injections(system, "an ensemble that returns");
  refuse_quasi_random(system, "an ensemble that returns");
}

// Bins that hold numbers of hits below a limit alone; the others are only longer.
BinnedCounts below(const BinnedCounts& counts, double limit) {
  BinnedCounts made;
  made.longer = counts.longer;
  for (const auto& bin : counts.bins.bins())
    if (bin.to <= limit)
      made.bins.add(bin.from, bin.count);
    else
      made.longer += bin.count;
  return made;
}

}  // namespace

}  // namespace analyses

void ReturnSums::Sum::operator+=(const Sum& other) {
  times += other.times;
  hits += other.hits;
  particles += other.particles;
  hits_in_half += other.hits_in_half;
  fewest_away = std::min(fewest_away, other.fewest_away);
}

bool ReturnsResult::add(const ReturnsResult& other) {
  if (!add_common(other)) return false;
  sums.merge(other.sums);
  add_ends(other);
  return true;
}

Returns returns_of(const ReturnSums& sums, double half) {
  using namespace results;
  constexpr std::size_t groups = ReturnSums::groups;
  ReturnSums::Sum all;
  for (std::size_t g = 0; g < groups; ++g) all += sums.of(g);
  // An excursion that is away may come back with its next hit.
  const double limit = static_cast<double>(all.fewest_away) + 1;
  std::vector<BinnedCounts> times, hits;
  std::vector<bool> filled;
  for (std::size_t g = 0; g < groups; ++g) {
    times.push_back(sums.of(g).times);
    hits.push_back(analyses::below(sums.of(g).hits, limit));
    filled.push_back(sums.of(g).particles > 0);
  }
  const std::vector<double> excursions = without_each(
      groups, [&](std::size_t g) { return static_cast<double>(sums.of(g).excursions()); });
  const auto ratio = [&](auto numerator) {
    if (excursions.back() == 0.0) return Estimate{nan, nan};
    const std::vector<double> above = without_each(groups, numerator);
    return jackknife(filled, [&](std::size_t g) { return above[g] / excursions[g]; });
  };
  Returns made;
  made.half = half;
  made.excursions = all.excursions();
  made.mean_time =
      ratio([&](std::size_t g) { return half * static_cast<double>(sums.of(g).particles); });
  made.mean_hits =
      ratio([&](std::size_t g) { return static_cast<double>(sums.of(g).hits_in_half); });
  made.times = distribution_of({times, half, made.mean_time.value / 64}, filled, {},
                               16 * made.mean_time.value);
  made.hits = distribution_of({hits, limit, 0.0}, filled, {}, 16 * made.mean_hits.value);
  // Numbers of hits are whole: of small ones most bins hold none.
  for (DistributionBin& bin : made.hits.bins) {
    const double width = bin.to - bin.from;
    bin.from = std::ceil(bin.from);
    bin.to = std::ceil(bin.to);
    const double whole = bin.to - bin.from;
    if (whole > 0.0)
      bin.density = {bin.density.value * width / whole, bin.density.error * width / whole};
  }
  std::erase_if(made.hits.bins, [](const DistributionBin& bin) { return bin.from == bin.to; });
  return made;
}

std::optional<ExpectedReturns> expected_returns(const System& as_written) {
  const System system = with_starts_of_the_flow(as_written);
  const double speed = system.particles.front().speed;
  // The centres of discs are bounded by other curves than the walls.
  if (!why_not_stationary(system).empty() || system.is_integrated() || system.of_discs() ||
      std::any_of(system.particles.begin(), system.particles.end(),
                  [&](const Particle& particle) { return particle.speed != speed; }))
    return std::nullopt;
  const TableMeasure m = measure(*system.table);
  const double length = geometry::length(system.table->wall(system.section.wall).curve);
  if (!std::isfinite(m.mean_flight)) return std::nullopt;  // where regions change speeds, too
  return ExpectedReturns{m.mean_flight * m.perimeter / (length * speed), m.perimeter / length};
}

ReturnsResult run_returns(const System& system, const EnsembleOptions<ReturnsResult>& options) {
  using namespace analyses;
  refuse_impossible(system);
  return engines::fly_blocks<ReturnsResult>(
      system, with_starts_of_the_flow(system), options, {},
      {.t_end = system.run.t_max, .hits = true},
      [&](const Engine& engine, ReturnsListener::Thread& thread) {
        return ReturnsListener(system, engine, thread);
      });
}

}  // namespace carom
