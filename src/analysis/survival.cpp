#include "carom/analysis/survival.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "carom/base/error.hpp"

namespace carom {

namespace {

// The 0.975 quantile of the normal distribution.
constexpr double quantile = 1.959963984540054;

// A share with its interval; `still_there` of `trials`.
struct Share {
  double p, low, high;
};
Share share(std::uint64_t still_there, std::uint64_t trials) {
  const Interval interval = wilson_interval(still_there, trials);
  const double p = trials == 0 ? std::numeric_limits<double>::quiet_NaN()
                               : static_cast<double>(still_there) / static_cast<double>(trials);
  return {p, interval.low, interval.high};
}

template <class Value>
void count_in(std::vector<std::uint64_t>& bins, const std::vector<Value>& ends, Value value) {
  // The first end at or after the value: a bin holds its end, not its start. The halves are chosen
  // without a branch, which would be foretold wrongly every other time.
  const Value* first = ends.data();
  for (std::size_t left = ends.size(); left > 0;) {
    const std::size_t half = (left + 1) / 2;
    first += half & (std::size_t{0} - static_cast<std::size_t>(first[half - 1] < value));
    left -= half;
  }
  const auto bin = static_cast<std::size_t>(first - ends.data());
  if (bin < ends.size()) ++bins[bin];
}

void add_each(std::vector<std::uint64_t>& sum, const std::vector<std::uint64_t>& other) {
  if (sum.size() != other.size()) throw InternalError("merged ensembles differ in their bins");
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += other[i];
}

}  // namespace

Interval wilson_interval(std::uint64_t successes, std::uint64_t trials) {
  if (trials == 0) return {};
  const double n = static_cast<double>(trials);
  const double k = static_cast<double>(successes);
  const double missed = static_cast<double>(trials - successes);
  const double z2 = quantile * quantile;
  const double middle = (k + z2 / 2) / (n + z2);
  const double half = quantile / (n + z2) * std::sqrt(k * (missed / n) + z2 / 4);
  // The ends are exact where nothing, or everything, succeeded.
  return {successes == 0 ? 0.0 : std::max(0.0, middle - half),
          successes == trials ? 1.0 : std::min(1.0, middle + half)};
}

const std::vector<std::uint64_t>& reported_hits() {
  static const std::vector<std::uint64_t> numbers = [] {
    constexpr std::uint64_t largest = std::uint64_t{1} << 63;
    std::vector<std::uint64_t> list{0};
    for (std::uint64_t decade = 1; decade < largest; decade *= 10) {
      for (const std::uint64_t digit : {1u, 2u, 3u, 5u}) {
        if (decade < largest / digit) list.push_back(digit * decade);
      }
      if (decade > largest / 10) break;
    }
    return list;
  }();
  return numbers;
}

SurvivalCounts::SurvivalCounts(std::vector<double> report_times, std::size_t holes)
    : times(std::move(report_times)),
      gone_in(times.size(), 0),
      gone_in_hits(reported_hits().size(), 0),
      hole_escapes(holes, 0) {}

void SurvivalCounts::add(Fate fate, double time, std::uint64_t hits, int hole) {
  ++trajectories;
  collisions += hits;
  most_hits = std::max(most_hits, hits);
  count(fate);
  if (fate == Fate::capped) ++survived;
  if (fate == Fate::capped || fate == Fate::survived)
    fewest_hits_of_survivor = std::min(fewest_hits_of_survivor, hits);
  if (fate != Fate::escaped && fate != Fate::unbounded) return;
  if (fate == Fate::escaped && hole >= 0) ++hole_escapes.at(static_cast<std::size_t>(hole));
  count_in(gone_in, times, time);
  gone_at.add(time);
  count_in(gone_in_hits, reported_hits(), hits);
  gone_after.add(static_cast<double>(hits) - 1.0);
}

void SurvivalCounts::merge(const SurvivalCounts& other) {
  add_fates(other);
  add_each(gone_in, other.gone_in);
  gone_at.merge(other.gone_at);
  gone_after.merge(other.gone_after);
  fewest_hits_of_survivor = std::min(fewest_hits_of_survivor, other.fewest_hits_of_survivor);
  add_each(gone_in_hits, other.gone_in_hits);
  add_each(hole_escapes, other.hole_escapes);
  trajectories += other.trajectories;
  collisions += other.collisions;
  contacts += other.contacts;
  most_hits = std::max(most_hits, other.most_hits);
  energy_change = std::max(energy_change, other.energy_change);
}

std::vector<SurvivalPoint> survival(const SurvivalCounts& counts) {
  std::vector<SurvivalPoint> points;
  std::uint64_t there = counts.followed();
  for (std::size_t i = 0; i < counts.times.size(); ++i) {
    there -= counts.gone_in[i];
    const auto [p, low, high] = share(there, counts.followed());
    points.push_back({counts.times[i], p, low, high});
  }
  return points;
}

std::vector<SurvivalHitsPoint> survival_by_hits(const SurvivalCounts& counts) {
  std::vector<SurvivalHitsPoint> points;
  std::uint64_t there = counts.followed();
  for (std::size_t i = 0; i < counts.gone_in_hits.size(); ++i) {
    const std::uint64_t n = reported_hits()[i];
    there -= counts.gone_in_hits[i];
    const auto [p, low, high] = share(there, counts.followed());
    points.push_back({n, p, low, high});
    if (n >= counts.most_hits) break;
  }
  return points;
}

std::vector<RatePoint> escape_rate(const SurvivalCounts& counts) {
  std::vector<RatePoint> points;
  double from = 0.0;
  for (std::size_t i = 0; i < counts.times.size(); ++i) {
    const double to = counts.times[i];
    if (to > from) {
      const auto [p, low, high] = share(counts.gone_in[i], counts.followed());
      const double width = to - from;
      const double middle = from > 0.0 ? std::sqrt(from) * std::sqrt(to) : to / 2;
      points.push_back({middle, from, to, p / width, low / width, high / width});
    }
    from = to;
  }
  return points;
}

}  // namespace carom
