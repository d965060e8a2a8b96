// Adds up displacements, trajectory by trajectory.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "analyses/diffusion/flights_seen.hpp"
#include "carom/analyses/diffusion.hpp"
#include "carom/engines/engine.hpp"
#include "carom/events/report.hpp"
#include "engines/energy_watch.hpp"
#include "engines/ensemble_run.hpp"

namespace carom::analyses {

/// One thread's.
class DiffusionListener : public engines::EnsembleListener<DiffusionResult> {
 public:
  DiffusionListener(const System& system, const Engine& engine, Thread& thread)
      : EnsembleListener(system, engine, thread) {}

  void begin(const Trajectory& t) override {
    if (under_way_.size() <= t.slot)
      under_way_.resize(
          t.slot + 1,
          {{}, {}, engines::EnergyWatch(system_, [this] { return thread_.stopped(); })});
    UnderWay& mine = under_way_[t.slot];
    mine.samples.resize(t.starts.size());
    for (Samples& samples : mine.samples) samples.clear();
    mine.flights.assign(system_.run.free_paths ? t.starts.size() : 0, {});
    mine.energies.begin(t);
  }

  void sample(const Trajectory& t, int particle, std::size_t number, const State& state) override {
    UnderWay& mine = under_way_[t.slot];
    const auto p = static_cast<std::size_t>(particle);
    mine.samples[p].add(sample_of(t.starts[p], state));
    mine.energies.sample(t, p, number, state);
  }

  void hit(const Trajectory& t, int particle, const State& state, std::uint64_t) override {
    const auto p = static_cast<std::size_t>(particle);
    under_way_[t.slot].flights[p].hit(state.time, t.particles[p].speed, half());
  }

  void end(const Trajectory& t, const TrajectoryEnd& end) override {
    UnderWay& mine = under_way_[t.slot];
    const engines::EnergiesSeen energies = mine.energies.end(t, end);
    const TrajectoryRange range{t.number, t.number + 1};
    std::uint64_t hits = 0;
    thread_.deliver(range, [&](DiffusionResult& sum) {
      for (std::size_t p = 0; p < end.particles.size(); ++p) {
        add(sum, t.number, index_of(t, p), end.particles[p], mine.samples[p]);
        hits += end.particles[p].hits;
        if (sum.free_paths.counted())
          sum.free_paths.add(t.number,
                             mine.flights[p].end(end.particles[p], t.particles[p].speed, half()));
      }
      sum.energy_change = larger(sum.energy_change, energies.change);
      add_end(sum, sum.contacts, end, energies.error);
      add_done(sum, range);
    });
    thread_.report(1, hits);
  }

 private:
  /// A particle at the report times that it reached.
  struct Samples {
    std::vector<double> squares;                      ///< |r - r(0)|^2
    std::vector<std::pair<double, double>> products;  ///< v . v(0) and v(0) . (r - r(0))
    void clear() { squares.clear(), products.clear(); }
    void add(const DisplacementSample& sample) {
      squares.push_back(sample.square);
      products.emplace_back(sample.velocities, sample.along);
    }
    DisplacementSample operator[](std::size_t k) const {
      return {squares[k], products[k].first, products[k].second};
    }
    /// How many come before one that cannot be summed.
    std::size_t usable() const {
      std::size_t k = 0;
      while (k < squares.size() && std::isfinite(squares[k] * squares[k]) &&
             std::isfinite(products[k].first) && std::isfinite(products[k].second))
        ++k;
      return k;
    }
  };
  /// What is known of a trajectory.
  struct UnderWay {
    std::vector<Samples> samples;  ///< of each particle
    std::vector<FlightsSeen> flights;
    engines::EnergyWatch energies;
  };

  /// Flights count that begin until then, so that all of them are seen up to the same length.
  double half() const { return system_.run.times.back() / 2; }

  DisplacementSample sample_of(const State& start, const State& now) const {
    geometry::Vector displacement = now.position - start.position;
    if (const auto& lattice = system_.table->lattice)
      displacement = displacement + lattice->translation({now.cell.first - start.cell.first,
                                                          now.cell.second - start.cell.second});
    return {dot(displacement, displacement), dot(now.velocity, start.velocity),
            dot(start.velocity, displacement)};
  }

  void add(DiffusionResult& sum, std::uint64_t trajectory, std::uint64_t index,
           const ParticleEnd& end, const Samples& all) const {
    Fate fate = end.fate;
    double time = end.time;
    std::string report = end.report;
    // A particle so far away that |r - r(0)|^4 is no number ends there as unresolved.
    const std::size_t samples = all.usable();
    if (samples < all.squares.size()) {
      fate = Fate::unresolved;
      time = sum.sums.times()[samples];
      report =
          report_of({}, end.state, fate, "it is so far away that |r - r(0)|^4 is not a number");
    }
    sum.add_end(fate, end.hits);
    for (std::size_t k = 0; k < samples; ++k) sum.sums.add(trajectory, k, all[k]);
    add_end(sum, index, fate, report,
            hash_(index, fate, time, end.hits, end.last_wall, end.state,
                  std::span(all.squares).first(samples)));
  }

  std::vector<UnderWay> under_way_;  ///< by slot
};

}  // namespace carom::analyses
