#include "carom/analyses/escape/survival.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "analyses/escape/sorted_ends.hpp"
#include "carom/base/error.hpp"

namespace carom {

namespace {

// Numbers of all trajectories, and then of those of each replicate.
class Portions {
 public:
  Portions(const SurvivalCounts& counts, std::vector<std::uint64_t> GoneCounts::*bins)
      : counts_(counts), bins_(bins) {
    numbers_.push_back({0, counts.followed()});
    for (const Replicate& one : counts.parts) numbers_.push_back({0, one.followed});
  }
  void none_gone() {
    for (Portion& one : numbers_) one.successes = one.trials;
  }
  void take_away(std::size_t bin) {
    for (std::size_t i = 0; i < numbers_.size(); ++i) numbers_[i].successes -= gone(i, bin);
  }
  void take(std::size_t bin) {
    for (std::size_t i = 0; i < numbers_.size(); ++i) numbers_[i].successes = gone(i, bin);
  }
  // The share of all, with its interval.
  ExitPoint share() const {
    const auto [k, n] = numbers_.front();
    const Interval interval = numbers_.size() == 1
                                  ? wilson_interval(k, n)
                                  : replicate_interval(std::span(numbers_).subspan(1));
    return {n == 0 ? std::numeric_limits<double>::quiet_NaN()
                   : static_cast<double>(k) / static_cast<double>(n),
            interval.low, interval.high};
  }

 private:
  std::uint64_t gone(std::size_t i, std::size_t bin) const {
    const GoneCounts& counts =
        i == 0 ? static_cast<const GoneCounts&>(counts_) : counts_.parts[i - 1];
    return (counts.*bins_)[bin];
  }
  const SurvivalCounts& counts_;
  std::vector<std::uint64_t> GoneCounts::*bins_;
  std::vector<Portion> numbers_;
};

void add_each(std::vector<std::uint64_t>& sum, const std::vector<std::uint64_t>& other) {
  if (sum.size() != other.size()) throw InternalError("merged ensembles differ in their bins");
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += other[i];
}

}  // namespace

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

namespace {

const analyses::SortedEnds& ends_of_hits() {
  static const analyses::SortedEnds ends({reported_hits().begin(), reported_hits().end()});
  return ends;
}

}  // namespace

SurvivalCounts::SurvivalCounts(std::vector<double> report_times, std::size_t holes,
                               bool quasi_random)
    : times(std::move(report_times)) {
  gone_in.resize(times.size());
  gone_in_hits.resize(reported_hits().size());
  hole_escapes.resize(holes);
  ends_ = std::make_shared<const analyses::SortedEnds>(times);
  if (quasi_random) parts.assign(replicates, {*this, 0});
}

void SurvivalCounts::add(Fate fate, double time, std::uint64_t hits, int hole,
                         std::uint64_t trajectory) {
  Replicate* const part = parts.empty() ? nullptr : &parts[trajectory % replicates];
  const std::uint64_t before = part ? followed() : 0;
  add_end(fate, hits);
  note(fate, hits);
  if (part) part->followed += followed() - before;
  if (fate != Fate::escaped && fate != Fate::unbounded) return;
  const std::size_t by_time = ends_ ? ends_->first_from(time) : 0,
                    by_hits = ends_of_hits().first_from(static_cast<double>(hits));
  const auto count_in = [&](GoneCounts& sum) {
    if (fate == Fate::escaped && hole >= 0) ++sum.hole_escapes.at(static_cast<std::size_t>(hole));
    if (by_time < sum.gone_in.size()) ++sum.gone_in[by_time];
    if (by_hits < sum.gone_in_hits.size()) ++sum.gone_in_hits[by_hits];
  };
  count_in(*this);
  if (part) count_in(*part);
  gone_at.add(time);
  gone_after.add(static_cast<double>(hits) - 1.0);
}

void GoneCounts::merge(const GoneCounts& other) {
  add_each(gone_in, other.gone_in);
  add_each(gone_in_hits, other.gone_in_hits);
  add_each(hole_escapes, other.hole_escapes);
}

void SurvivalCounts::merge(const SurvivalCounts& other) {
  add_ends(other);
  GoneCounts::merge(other);
  join_fields<SurvivalNumbers>(*this, other);
  if (parts.size() != other.parts.size())
    throw InternalError("merged ensembles differ in their replicates");
  for (std::size_t r = 0; r < parts.size(); ++r) {
    parts[r].merge(other.parts[r]);
    parts[r].followed += other.parts[r].followed;
  }
  gone_at.merge(other.gone_at);
  gone_after.merge(other.gone_after);
}

std::vector<SurvivalPoint> survival(const SurvivalCounts& counts) {
  std::vector<SurvivalPoint> points;
  Portions there(counts, &GoneCounts::gone_in);
  there.none_gone();
  for (std::size_t i = 0; i < counts.times.size(); ++i) {
    there.take_away(i);
    const auto [p, low, high] = there.share();
    points.push_back({counts.times[i], p, low, high});
  }
  return points;
}

std::vector<SurvivalHitsPoint> survival_by_hits(const SurvivalCounts& counts) {
  std::vector<SurvivalHitsPoint> points;
  Portions there(counts, &GoneCounts::gone_in_hits);
  there.none_gone();
  for (std::size_t i = 0; i < counts.gone_in_hits.size(); ++i) {
    const std::uint64_t n = reported_hits()[i];
    there.take_away(i);
    const auto [p, low, high] = there.share();
    points.push_back({n, p, low, high});
    if (n >= counts.most_hits) break;
  }
  return points;
}

std::vector<RatePoint> escape_rate(const SurvivalCounts& counts) {
  std::vector<RatePoint> points;
  Portions gone(counts, &GoneCounts::gone_in);
  double from = 0.0;
  for (std::size_t i = 0; i < counts.times.size(); ++i) {
    const double to = counts.times[i];
    if (to > from) {
      gone.take(i);
      const auto [p, low, high] = gone.share();
      const double width = to - from;
      const double middle = from > 0.0 ? std::sqrt(from) * std::sqrt(to) : to / 2;
      points.push_back({middle, from, to, p / width, low / width, high / width});
    }
    from = to;
  }
  return points;
}

std::vector<ExitPoint> exits(const SurvivalCounts& counts) {
  std::vector<ExitPoint> points;
  Portions gone(counts, &GoneCounts::hole_escapes);
  for (std::size_t hole = 0; hole < counts.hole_escapes.size(); ++hole) {
    gone.take(hole);
    points.push_back(gone.share());
  }
  return points;
}

}  // namespace carom
