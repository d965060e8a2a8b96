#include "analyses/lyapunov/lyapunov_listener.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "carom/base/digest.hpp"
#include "carom/starts/injection.hpp"
#include "carom/starts/start_measure.hpp"

namespace carom::analyses {

GrowthTimes::GrowthTimes(const GrowthSums& plan, const ConvergenceSums& convergence) {
  marks_.push_back({.time = plan.window().from, .opens = true});
  for (std::size_t block = 0; block < plan.blocks(); ++block)
    marks_.push_back({.time = plan.block_end(block), .block = static_cast<int>(block)});
  for (std::size_t look = 0; look < GrowthSums::looks; ++look)
    marks_.push_back({.time = plan.look_time(look), .look = static_cast<int>(look)});
  for (std::size_t i = 0; i < convergence.times().size(); ++i) {
    const double time = convergence.times()[i];
    const auto look = std::find_if(marks_.begin(), marks_.end(), [&](const Mark& mark) {
      return mark.look >= 0 && mark.time == time;
    });
    Mark& at = look != marks_.end() ? *look : marks_.emplace_back(Mark{.time = time});
    at.point = static_cast<int>(i);
  }
  std::stable_sort(marks_.begin(), marks_.end(),
                   [](const Mark& a, const Mark& b) { return a.time < b.time; });
}

std::vector<double> GrowthTimes::times() const {
  std::vector<double> list;
  for (const Mark& mark : marks_) list.push_back(mark.time);
  return list;
}

LyapunovListener::LyapunovListener(const System& system, const GrowthTimes& times,
                                   const GrowthSums& plan, double unit_length, const Engine& engine,
                                   Thread& thread)
    : EnsembleListener(system, engine, thread),
      marks_(times.marks()),
      blocks_(plan.blocks()),
      unit_length_(unit_length),
      together_(interacts(system)),
      from_walls_(starts_of_the_map(system)),
      growing_(growing_exponents(system)),
      record_of_(system),
      watch_(system, [this] { return thread_.stopped(); }) {}

void LyapunovListener::begin(const Trajectory& t) {
  if (under_way_.size() <= t.slot) {
    under_way_.resize(t.slot + 1);
    energies_.resize(t.slot + 1, watch_);
  }
  energies_[t.slot].begin(t);
  std::vector<Orbit>& orbits = under_way_[t.slot];
  orbits.resize(t.starts.size());
  for (std::size_t p = 0; p < orbits.size(); ++p) {
    Orbit& mine = orbits[p];
    const geometry::Vector v = t.starts[p].velocity;
    mine.pace = std::sqrt(dot(v, v)) / unit_length_;
    mine.hits_before = 0;
    mine.marked = mine.grown = mine.spread = 0.0;
    mine.chaotic = false;
    mine.growth.growth.assign(blocks_, 0.0);
    mine.growth.hits.assign(blocks_, 0);
    mine.growth.regularity = Regularity::undecided;
    mine.growth.look = 0;
    mine.growth.flights = mine.pace * marks_.back().time;
    mine.frame.clear();
    mine.convergence.resize(marks_.size());
  }
}

void LyapunovListener::stretched(const Trajectory& t, int particle, std::size_t number,
                                 std::span<const double> logarithms, std::uint64_t hits) {
  take(under_way_[t.slot][static_cast<std::size_t>(particle)], marks_[number], logarithms, hits);
}

void LyapunovListener::take(Orbit& mine, const GrowthTimes::Mark& mark,
                            std::span<const double> logarithms, std::uint64_t hits) const {
  mine.marked = mark.time;
  mine.grown = logarithms[0];
  // Of a frame the growth of the first tells: that of the second may be another particle's.
  const bool frame = system_.run.spectrum;
  mine.spread = logarithms[0] + logarithms[frame ? 0 : 1];
  if (mark.point >= 0) {
    mine.convergence[static_cast<std::size_t>(mark.point)] = logarithms[0];
    if (mark.look < 0) return;
  }
  if (mark.look >= 0 && !mine.chaotic) {
    mine.growth.regularity = regularity_of(mine.spread, mark.time * mine.pace);
    mine.chaotic = mine.growth.regularity == Regularity::chaotic;
    if (mine.chaotic) mine.growth.look = static_cast<std::size_t>(mark.look);
  }
  if (mark.look >= 0) {
    const auto& looks = DriftSums::looks;
    const auto at = std::find(looks.begin(), looks.end(), static_cast<std::size_t>(mark.look));
    if (at == looks.end()) return;
    const auto i = static_cast<std::size_t>(at - looks.begin());
    mine.lengths[i] = logarithms[0];
    mine.volumes[i] = std::accumulate(
        logarithms.begin(), logarithms.begin() + static_cast<std::ptrdiff_t>(growing_), 0.0);
    return;
  }
  if (!mark.opens) {
    const auto block = static_cast<std::size_t>(mark.block);
    mine.growth.growth[block] = logarithms[0] - mine.length;
    mine.growth.hits[block] = hits - mine.hits_before;
    for (std::size_t i = 0; frame && i < logarithms.size(); ++i)
      mine.frame.push_back(logarithms[i] - mine.frame_before[i]);
  }
  mine.length = logarithms[0];
  mine.hits_before = hits;
  if (frame) mine.frame_before.assign(logarithms.begin(), logarithms.end());
}

// The exponent over the window, or, of a particle that ended before, since its start until the last
// time at which its deviations were looked at.
TrajectoryRecord LyapunovListener::record(const Trajectory& t, const TrajectoryEnd& end,
                                          std::size_t p) const {
  TrajectoryRecord r = record_of_(index_of(t, p), t.starts[p], end.particles[p]);
  // Those that interact are one orbit, whose deviations come with the first.
  const Orbit& mine = under_way_[t.slot][together_ ? 0 : p];
  if (!(mine.marked > 0.0)) return r;
  const TimeWindow window = growth_window(system_);
  double growth = 0.0;
  for (const double block : mine.growth.growth) growth += block;
  r.lambda =
      mine.marked >= window.to ? growth / (window.to - window.from) : mine.grown / mine.marked;
  r.sali = sali_of(mine.spread);
  r.regularity = static_cast<unsigned char>(mine.growth.regularity);
  return r;
}

// Does an orbit count to the end of the window?
bool LyapunovListener::stays(const ParticleEnd& end) const {
  return end.fate == Fate::survived || (end.fate == Fate::pinned && !from_walls_);
}

void LyapunovListener::end(const Trajectory& t, const TrajectoryEnd& end) {
  std::vector<Orbit>& orbits = under_way_[t.slot];
  const engines::EnergiesSeen energies = energies_[t.slot].end(t, end);
  const TrajectoryRange range{t.number, t.number + 1};
  std::uint64_t hits = 0;
  bool all = true;
  std::vector<TrajectoryRecord> records;
  if (thread_.wants_records())
    for (std::size_t p = 0; p < end.particles.size(); ++p) records.push_back(record(t, end, p));
  for (const ParticleEnd& one : end.particles) all = all && stays(one);
  thread_.deliver(
      range,
      [&](LyapunovResult& sum) {
        for (std::size_t p = 0; p < end.particles.size(); ++p) {
          Orbit& mine = orbits[p];
          const ParticleEnd& particle = end.particles[p];
          const std::uint64_t index = index_of(t, p);
          hits += particle.hits;
          sum.add_end(particle.fate, particle.hits);
          std::uint64_t hash = hash_(index, particle.fate, particle.time, particle.hits,
                                     particle.last_wall, particle.state);
          if (together_ ? all && p == 0 : stays(particle)) {
            sum.growth.add(mine.growth, t.number);
            for (const double growth : mine.growth.growth) hash = mix(hash, growth);
            sum.convergence.add(mine.convergence);
            sum.drift.add(mine.lengths, sum.growth.window().to);
            if (sum.spectrum.counted()) {
              sum.spectrum.add(mine.frame);
              sum.entropy_drift.add(mine.volumes, sum.growth.window().to);
            }
            for (const double growth : mine.frame) hash = mix(hash, growth);
          }
          add_end(sum, index, particle.fate, particle.report, hash);
        }
        add_end(sum, sum.contacts, end, energies.error);
        add_done(sum, range);
      },
      std::move(records));
  thread_.report(1, hits);
}

}  // namespace carom::analyses
