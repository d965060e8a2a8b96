#include "carom/analysis/growth.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "carom/base/elementary.hpp"
#include "carom/base/error.hpp"

namespace carom {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// On an invariant curve deviations grow by shear, |w1| |w2| = (C flights)^2. C is of order one but
// near a separatrix: there an orbit at the distance d of it may pass for chaotic if 1/d^2 > C^2.
// Both bounds allow for that; an orbit between them is undecided.
constexpr double most_of_regular = 13.815510557964274;   // ln 10^6
constexpr double least_of_chaotic = 27.631021115928547;  // ln 10^12

constexpr std::uint64_t wanted = 64;  // blocks of all orbits
std::uint64_t blocks_for(std::uint64_t orbits) {
  return orbits >= wanted ? 1 : std::bit_ceil(wanted / std::max<std::uint64_t>(1, orbits));
}

double root(double square) { return std::sqrt(std::max(0.0, square)); }

}  // namespace

void GrowingHistogram::widen() {
  const std::int64_t half = first_ >> 1;  // towards minus infinity
  std::vector<std::uint64_t> wide;
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    const auto bin =
        static_cast<std::size_t>(((first_ + static_cast<std::int64_t>(i)) >> 1) - half);
    if (wide.size() <= bin) wide.resize(bin + 1);
    wide[bin] += counts_[i];
  }
  first_ = half;
  counts_ = std::move(wide);
  ++exponent_;
}

// Adds counters for the bins from … to of the present width.
void GrowingHistogram::reach(std::int64_t from, std::int64_t to) {
  if (counts_.empty()) first_ = from;
  const auto size = static_cast<std::int64_t>(counts_.size());
  for (std::int64_t low = std::min(from, first_), high = std::max(to + 1, first_ + size);
       high - low > static_cast<std::int64_t>(most); low >>= 1, high = ((high - 1) >> 1) + 1) {
    widen();
    from >>= 1, to >>= 1;
  }
  if (from < first_) {
    counts_.insert(counts_.begin(), static_cast<std::size_t>(first_ - from), 0);
    first_ = from;
  }
  const auto needed = static_cast<std::size_t>(to + 1 - first_);
  if (counts_.size() < needed) counts_.resize(needed);
}

void GrowingHistogram::add(double x, std::uint64_t count) {
  const auto bin = static_cast<std::int64_t>(std::floor(std::ldexp(x, -exponent_)));
  const int before = exponent_;
  reach(bin, bin);
  counts_[static_cast<std::size_t>((bin >> (exponent_ - before)) - first_)] += count;
}

void GrowingHistogram::merge(const GrowingHistogram& other) {
  if (other.counts_.empty()) return;
  GrowingHistogram theirs = other;
  while (exponent_ < theirs.exponent_ && !counts_.empty()) widen();
  if (counts_.empty()) exponent_ = theirs.exponent_;
  while (theirs.exponent_ < exponent_) theirs.widen();
  reach(theirs.first_, theirs.first_ + static_cast<std::int64_t>(theirs.counts_.size()) - 1);
  while (theirs.exponent_ < exponent_) theirs.widen();
  for (std::size_t i = 0; i < theirs.counts_.size(); ++i)
    counts_[static_cast<std::size_t>(theirs.first_ - first_) + i] += theirs.counts_[i];
}

GrowingHistogram GrowingHistogram::from(int exponent, std::int64_t first,
                                        std::vector<std::uint64_t> counts) {
  GrowingHistogram made;
  made.exponent_ = exponent;
  made.first_ = first;
  made.counts_ = std::move(counts);
  return made;
}

Regularity regularity_of(double spread, double flights) {
  const double excess = spread - 2.0 * elementary::log(flights + 1.0);
  return excess > least_of_chaotic  ? Regularity::chaotic
         : excess > most_of_regular ? Regularity::undecided
                                    : Regularity::regular;
}

double sali_of(double spread) {
  // The area that is kept is the product of the lengths and the sine of the angle.
  const double sine = std::min(1.0, elementary::exp(-std::max(0.0, spread)));
  const double cosine = std::sqrt((1.0 - sine) * (1.0 + sine));
  return sine * std::sqrt(2.0 / (1.0 + cosine));
}

GrowthSums::GrowthSums(TimeWindow window, std::uint64_t orbits, bool quasi_random)
    : window_(window),
      blocks_(quasi_random ? 1 : static_cast<std::size_t>(blocks_for(orbits))),
      parts_(quasi_random ? replicates : 0) {
  totals_.levels.resize(static_cast<std::size_t>(std::bit_width(blocks_)));
}

GrowthSums GrowthSums::from(TimeWindow window, std::uint64_t blocks, Totals totals,
                            std::vector<Totals> parts) {
  GrowthSums sums;
  sums.window_ = window;
  sums.blocks_ = blocks;
  sums.totals_ = std::move(totals);
  sums.parts_ = std::move(parts);
  sums.totals_.levels.resize(static_cast<std::size_t>(std::bit_width(blocks)));
  return sums;
}
bool GrowthSums::may_be_blocks(std::uint64_t blocks) {
  return std::has_single_bit(blocks) && blocks <= wanted;
}

double GrowthSums::block_end(std::size_t block) const {
  return block + 1 == blocks_ ? window_.to
                              : window_.from + static_cast<double>(block + 1) * block_length();
}
double GrowthSums::look_time(std::size_t look) const {
  return std::ldexp(window_.to, static_cast<int>(look) - static_cast<int>(looks) + 1);
}

namespace {

// What replicates keep, too; `growth` and `hits` over the window.
void count(GrowthSums::Totals& t, const OrbitGrowth& orbit, double growth, double hits) {
  ++t.orbits;
  t.growth.add(growth);
  t.hits.add(hits);
  t.regular += orbit.regularity == Regularity::regular;
  if (orbit.regularity != Regularity::chaotic) return;
  ++t.chaotic;
  ++t.chaotic_at.at(orbit.look);
  t.chaotic_growth.add(growth);
}

void merge_counts(GrowthSums::Totals& t, const GrowthSums::Totals& o) {
  t.orbits += o.orbits, t.chaotic += o.chaotic, t.regular += o.regular;
  for (std::size_t i = 0; i < GrowthSums::looks; ++i) t.chaotic_at[i] += o.chaotic_at[i];
  t.growth.merge(o.growth);
  t.hits.merge(o.hits);
  t.chaotic_growth.merge(o.chaotic_growth);
}

}  // namespace

void GrowthSums::add(const OrbitGrowth& orbit, std::uint64_t trajectory) {
  if (orbit.growth.size() != blocks_ || orbit.hits.size() != blocks_)
    throw InternalError("an orbit with another number of blocks");
  Totals& t = totals_;
  std::vector<double> growth = orbit.growth;
  std::vector<double> hits(orbit.hits.begin(), orbit.hits.end());
  for (Squares& level : t.levels) {
    for (std::size_t i = 0; i < growth.size(); ++i) {
      level.growth.add(growth[i] * growth[i]);
      level.product.add(growth[i] * hits[i]);
      level.hits.add(hits[i] * hits[i]);
    }
    for (std::size_t i = 0; 2 * i + 1 < growth.size(); ++i) {
      growth[i] = growth[2 * i] + growth[2 * i + 1];
      hits[i] = hits[2 * i] + hits[2 * i + 1];
    }
    growth.resize(std::max<std::size_t>(1, growth.size() / 2));
    hits.resize(growth.size());
  }
  count(t, orbit, growth.front(), hits.front());
  if (!parts_.empty()) count(parts_[trajectory % replicates], orbit, growth.front(), hits.front());
  t.distribution.add(growth.front());
  if (orbit.regularity == Regularity::chaotic)
    t.chaotic_squares.add(growth.front() * growth.front());
}

void GrowthSums::merge(const GrowthSums& other) {
  Totals& t = totals_;
  const Totals& o = other.totals_;
  if (t.levels.size() != o.levels.size() || parts_.size() != other.parts_.size())
    throw InternalError("sums of another window");
  merge_counts(t, o);
  for (std::size_t r = 0; r < parts_.size(); ++r) merge_counts(parts_[r], other.parts_[r]);
  t.chaotic_squares.merge(o.chaotic_squares);
  for (std::size_t i = 0; i < t.levels.size(); ++i) {
    t.levels[i].growth.merge(o.levels[i].growth);
    t.levels[i].product.merge(o.levels[i].product);
    t.levels[i].hits.merge(o.levels[i].hits);
  }
  t.distribution.merge(o.distribution);
}

namespace {

// Numbers of orbits, and sums over them, that an estimate is a function of.
struct Numbers {
  double orbits, chaotic, late, before, growth, hits, chaotic_growth;
};
Numbers numbers_of(const GrowthSums::Totals& t) {
  return {static_cast<double>(t.orbits),
          static_cast<double>(t.chaotic),
          static_cast<double>(t.chaotic_at[GrowthSums::looks - 1]),
          static_cast<double>(t.chaotic_at[GrowthSums::looks - 2]),
          t.growth.value(),
          t.hits.value(),
          t.chaotic_growth.value()};
}
Numbers operator-(const Numbers& a, const Numbers& b) {
  return {a.orbits - b.orbits,
          a.chaotic - b.chaotic,
          a.late - b.late,
          a.before - b.before,
          a.growth - b.growth,
          a.hits - b.hits,
          a.chaotic_growth - b.chaotic_growth};
}

// Those found chaotic fall by a factor r = before/late with each doubling: late/r + late/r^2 + …
// are to come.
double hidden_of(const Numbers& t) { return t.late * t.late / (t.before - t.late); }

double share_of(const Numbers& t, bool falls) {
  return std::min(1.0, (t.chaotic + (falls ? hidden_of(t) : 0.0)) / t.orbits);
}

// The share that is chaotic, with those that have not shown yet. Its error, by that of both
// numbers, which are Poisson's.
void estimate_share(const Numbers& t, LyapunovEstimate& out) {
  const double n = t.orbits, late = t.late, before = t.before, fall = before - late;
  double variance = 0.0;
  const bool falls = fall > 3.0 * root(before + late);
  if (falls) {
    out.hidden = hidden_of(t) / n;
    const double by_late = (2.0 * late * fall + late * late) / (fall * fall),
                 by_before = late * late / (fall * fall);
    variance = by_late * by_late * late + by_before * by_before * before;
  }
  out.settled = falls || late <= root(n);
  const double share = share_of(t, falls);
  out.chaotic_share = {share, root(share * (1.0 - share) / n + variance / (n * n))};
}

// Of quasi-random starts: errors by what the estimates are without one replicate after the other.
void estimate_errors(const std::vector<GrowthSums::Totals>& parts, const Numbers& all,
                     double duration, LyapunovEstimate& out) {
  out.block_errors.clear();
  const auto none = [](const GrowthSums::Totals& t) { return t.orbits == 0; };
  const bool empty = std::any_of(parts.begin(), parts.end(), none);
  const auto error = [&](auto number) {
    return empty
               ? nan
               : jackknife_error([&](std::size_t r) { return number(all - numbers_of(parts[r])); });
  };
  out.per_time.error = error([&](const Numbers& t) { return t.growth / (t.orbits * duration); });
  out.per_hit.error = error([](const Numbers& t) { return t.growth / t.hits; });
  out.chaotic.error =
      error([&](const Numbers& t) { return t.chaotic_growth / (t.chaotic * duration); });
  const bool falls = out.hidden > 0.0;
  out.chaotic_share.error = std::max(error([&](const Numbers& t) { return share_of(t, falls); }),
                                     root(least_variance(all.chaotic, all.orbits)) / all.orbits);
}

}  // namespace

LyapunovEstimate estimate_of(const GrowthSums& sums) {
  const GrowthSums::Totals& t = sums.totals();
  LyapunovEstimate out;
  out.per_time = out.per_hit = out.chaotic = out.chaotic_share = {nan, nan};
  if (t.orbits == 0) return out;
  const auto n = static_cast<double>(t.orbits);
  const double duration = sums.window().to - sums.window().from;
  const double growth = t.growth.value(), hits = t.hits.value(), ratio = growth / hits;
  out.per_time.value = growth / (n * duration);
  if (hits > 0.0) out.per_hit.value = ratio;
  for (std::size_t level = 0; level < t.levels.size(); ++level) {
    const std::uint64_t each = sums.blocks() >> level, count = t.orbits * each;
    if (count < GrowthSums::enough_blocks) break;
    const auto m = static_cast<double>(count);
    const GrowthSums::Squares& s = t.levels[level];
    const double square = s.growth.value(), mean = growth / m;
    const double error = root((square / m - mean * mean) / (m - 1.0)) * m / (n * duration);
    out.block_errors.push_back({duration / static_cast<double>(each), count, error});
    out.per_time.error = error;
    // The ratio of two sums: that of the residuals growth - ratio hits.
    if (hits > 0.0)
      out.per_hit.error =
          root((square - 2.0 * ratio * s.product.value() + ratio * ratio * s.hits.value()) *
               (m / (m - 1.0))) /
          hits;
  }
  // Whole orbits are independent. Blocks of few orbits may not be: their error is believed if it
  // does not grow with their length. From the shortest blocks to the longest that of independent
  // ones moves by about its own uncertainty; beyond 1.5 of these it is doubted (7 % of noise is).
  if (sums.blocks() > 1 && out.block_errors.size() > 1 &&
      out.block_errors.back().count > t.orbits) {
    const auto& last = out.block_errors.back();
    const auto& first = out.block_errors.front();
    const double uncertain = 1.0 / root(2.0 * static_cast<double>(last.count - 1));
    out.long_enough = last.error <= first.error * (1.0 + 1.5 * uncertain);
  }
  if (t.chaotic > 1) {
    const auto m = static_cast<double>(t.chaotic);
    const double mean = t.chaotic_growth.value() / m;
    out.chaotic = {mean / duration,
                   root((t.chaotic_squares.value() / m - mean * mean) / (m - 1.0)) / duration};
  }
  const Numbers all = numbers_of(t);
  estimate_share(all, out);
  if (!sums.parts().empty()) estimate_errors(sums.parts(), all, duration, out);
  return out;
}

std::vector<ExponentBin> distribution_of(const GrowthSums& sums) {
  const GrowingHistogram& h = sums.totals().distribution;
  const double duration = sums.window().to - sums.window().from;
  std::vector<ExponentBin> bins;
  const auto edge = [&](std::int64_t bin) {
    return std::ldexp(static_cast<double>(bin), h.exponent()) / duration;
  };
  for (std::size_t i = 0; i < h.counts().size(); ++i) {
    const std::int64_t bin = h.first() + static_cast<std::int64_t>(i);
    bins.push_back({edge(bin), edge(bin + 1), h.counts()[i]});
  }
  return bins;
}

}  // namespace carom
