#include "carom/analyses/lyapunov/growth.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "base/student.hpp"
#include "carom/base/elementary.hpp"
#include "carom/base/error.hpp"
#include "results/numbers.hpp"

namespace carom {

namespace {

using results::nan;
using results::normal_quantile;
using results::root;

// On an invariant curve deviations grow by shear, |w1| |w2| = (C flights)^2. C is of order one but
// near a separatrix: there an orbit at the distance d of it may pass for chaotic if 1/d^2 > C^2.
// Both bounds allow for that; an orbit between them is undecided.
constexpr double most_of_linear = 13.815510557964274;    // ln 10^6
constexpr double least_of_chaotic = 27.631021115928547;  // ln 10^12

std::uint64_t blocks_for(std::uint64_t orbits) {
  return orbits >= GrowthSums::few_orbits
             ? 1
             : std::bit_ceil(GrowthSums::wanted_blocks / std::max<std::uint64_t>(1, orbits));
}

// Two independent errors.
double both(double a, double b) { return std::sqrt(a * a + b * b); }

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
  return excess > least_of_chaotic ? Regularity::chaotic
         : excess > most_of_linear ? Regularity::undecided
                                   : Regularity::linear;
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
  return std::has_single_bit(blocks) && blocks <= wanted_blocks;
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
  t.linear += orbit.regularity == Regularity::linear;
  if (orbit.regularity != Regularity::chaotic) return;
  ++t.chaotic;
  ++t.chaotic_at.at(orbit.look);
  t.chaotic_growth.add(growth);
}

void merge_counts(GrowthSums::Totals& t, const GrowthSums::Totals& o) {
  t.orbits += o.orbits, t.chaotic += o.chaotic, t.linear += o.linear;
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
  t.flights.add(orbit.flights);
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
  t.flights.merge(o.flights);
  for (std::size_t i = 0; i < t.levels.size(); ++i) {
    t.levels[i].growth.merge(o.levels[i].growth);
    t.levels[i].product.merge(o.levels[i].product);
    t.levels[i].hits.merge(o.levels[i].hits);
  }
  t.distribution.merge(o.distribution);
}

namespace {

// Half of the width of an interval of 95 % in standard errors, of a normal distribution and of
// Student's with m numbers: errors of few numbers are given so much larger that 1.96 of them hold.
double student_factor(std::uint64_t m) {
  return base::student_quantile(0.975, static_cast<double>(m - 1)) / normal_quantile;
}

// Numbers of orbits, and sums over them, that an estimate is a function of.
struct Numbers {
  double orbits, chaotic, growth, hits, chaotic_growth;
};
Numbers numbers_of(const GrowthSums::Totals& t) {
  return {static_cast<double>(t.orbits), static_cast<double>(t.chaotic), t.growth.value(),
          t.hits.value(), t.chaotic_growth.value()};
}
Numbers operator-(const Numbers& a, const Numbers& b) {
  return {a.orbits - b.orbits, a.chaotic - b.chaotic, a.growth - b.growth, a.hits - b.hits,
          a.chaotic_growth - b.chaotic_growth};
}

// Of quasi-random starts: errors by what a number is without one replicate after the other.
double replicate_error(const std::vector<GrowthSums::Totals>& parts, const Numbers& all,
                       auto number) {
  if (std::any_of(parts.begin(), parts.end(),
                  [](const GrowthSums::Totals& t) { return t.orbits == 0; }))
    return nan;
  return jackknife_error([&](std::size_t r) { return number(all - numbers_of(parts[r])); });
}

// Means over all orbits and their errors, whatever the law of growth.
void estimate_means(const GrowthSums& sums, LyapunovEstimate& out) {
  const GrowthSums::Totals& t = sums.totals();
  const auto n = static_cast<double>(t.orbits);
  const double duration = sums.window().to - sums.window().from;
  const double growth = t.growth.value(), hits = t.hits.value(), ratio = growth / hits;
  out.per_time.value = growth / (n * duration);
  if (hits > 0.0) out.per_hit.value = ratio;
  if (!sums.parts().empty()) {
    const Numbers all = numbers_of(t);
    out.per_time.error = replicate_error(
        sums.parts(), all, [&](const Numbers& x) { return x.growth / (x.orbits * duration); });
    out.per_hit.error =
        replicate_error(sums.parts(), all, [](const Numbers& x) { return x.growth / x.hits; });
    return;
  }
  for (std::size_t level = 0; level < t.levels.size(); ++level) {
    const std::uint64_t each = sums.blocks() >> level, count = t.orbits * each;
    if (count < GrowthSums::enough_blocks) break;
    const auto m = static_cast<double>(count);
    const GrowthSums::Squares& s = t.levels[level];
    const double square = s.growth.value(), mean = growth / m;
    const double error = results::root((square / m - mean * mean) / (m - 1.0)) * m / (n * duration);
    out.block_errors.push_back({duration / static_cast<double>(each), count, error});
    out.per_time.error = error;
    // The ratio of two sums: that of the residuals growth - ratio hits.
    if (hits > 0.0)
      out.per_hit.error = results::root((square - 2.0 * ratio * s.product.value() +
                                         ratio * ratio * s.hits.value()) *
                                        (m / (m - 1.0))) /
                          hits;
  }
  if (sums.blocks() == 1 || out.block_errors.empty()) return;
  // Few orbits. Stays whose number falls as the square of their length make the variance grow by
  // the same amount with each doubling of the blocks, up to the whole orbit. The many short blocks
  // tell that amount; the few long ones, in which a long stay is often missing, do not.
  constexpr std::size_t middle = 2, later = 4;
  const auto& errors = out.block_errors;
  const auto& last = errors.back();
  double error = last.error * student_factor(last.count);
  if (errors.size() > later && errors.front().count >= GrowthSums::wanted_blocks) {
    const auto square = [&](std::size_t i) { return errors[i].error * errors[i].error; };
    const double slope = std::max(0.0, square(middle) - square(0)) / middle;
    const auto doublings = static_cast<double>(t.levels.size() - 1 - middle);
    error = std::max(error, results::root(square(middle) + doublings * slope) *
                                student_factor(errors[middle].count));
    // Of independent blocks an error moves by about its own uncertainty; beyond 1.5 of these it is
    // doubted.
    out.long_enough =
        errors[later].error <=
        errors[middle].error *
            (1.0 + 1.5 / results::root(2.0 * static_cast<double>(errors[later].count - 1)));
  }
  // Blocks in which deviations grow little are shorter than what these remember, and so short an
  // orbit knows little of long stays.
  constexpr double least_growth = 5.0;
  if (growth < least_growth * static_cast<double>(GrowthSums::wanted_blocks))
    out.long_enough = false;
  if (last.error > 0.0) out.per_hit.error *= error / last.error;
  out.per_time.error = error;
}

// The time after which an orbit whose deviations grow as exp(rate t) from the start on is found
// chaotic: 2 rate t - 2 ln(flights(t) + 1) = ln 10^12.
double waiting_time_of(double rate, double flights_per_time) {
  double time = least_of_chaotic / (2.0 * rate);
  for (int i = 0; i < 50; ++i)
    time = (0.5 * least_of_chaotic + elementary::log(flights_per_time * time + 1.0)) / rate;
  return time;
}

// Wilson's interval, of numbers that need not be whole.
Interval wilson(double k, double n) {
  constexpr double z2 = normal_quantile * normal_quantile;
  const double p = k / n, scale = 1.0 / (1.0 + z2 / n), centre = (p + z2 / (2.0 * n)) * scale;
  const double half =
      normal_quantile * scale * results::root(p * (1.0 - p) / n + z2 / (4.0 * n * n));
  return {centre - half, centre + half};
}

// A run that shows a share is this many waiting times long.
constexpr double waiting_times = 3.0;

// The share that is chaotic, with those that have not shown yet: they stick to islands or between
// parallel walls, and leave with a power law (docs/physics/lyapunov.md).
void estimate_share(const GrowthSums& sums, LyapunovEstimate& out) {
  const GrowthSums::Totals& t = sums.totals();
  const double end = sums.window().to, wait = out.waiting_time;
  const auto n = static_cast<double>(t.orbits), found = static_cast<double>(t.chaotic),
             late = static_cast<double>(t.chaotic_at[GrowthSums::looks - 1]);
  // What has left by a look has left one waiting time before.
  const double ratio = (end - wait) / (0.5 * end - wait);
  const double many =
      late + 2.0 * results::root(late) + 3.0;  // 97.5 % of Poisson's numbers are not above
  const double hidden = std::min(late / (ratio - 1.0), n - found);
  const double most = std::clamp(many / (results::root(ratio) - 1.0), hidden, n - found);
  out.hidden = hidden / n;
  out.hidden_error = std::max(hidden, most - hidden) / (n * normal_quantile);
  const double share = std::min(1.0, (found + hidden) / n);
  Interval counted = wilson(std::min(found + hidden, n), n);
  if (!sums.parts().empty()) {
    const Numbers all = numbers_of(t);
    const double error =
        replicates_quantile *
        std::max(replicate_error(sums.parts(), all,
                                 [](const Numbers& x) { return x.chaotic / x.orbits; }),
                 results::root(least_variance(found, n)) / n);
    counted = {share - error, share + error};
  }
  const double low = both(share - counted.low, out.hidden),
               high = both(counted.high - share, (most - hidden) / n);
  out.chaotic_share = {share, nan};
  // All may be chaotic: exactly 1, not a rounding less.
  const bool all = found + most >= n;
  out.share_interval = {std::max(0.0, share - low), all ? 1.0 : std::min(1.0, share + high)};
  if (std::isfinite(low))
    out.chaotic_share.error =
        std::max(share - out.share_interval.low, out.share_interval.high - share) / normal_quantile;
  else
    out.share_interval = {0.0, 1.0};  // of replicates without an orbit
}

// The exponent of the chaotic orbits, with those that have not shown yet: without these it would be
// that of orbits that left early. Shares and exponents of the counted orbits scatter together, so
// that only what is not known of the hidden ones is an error more.
void estimate_chaotic(const GrowthSums& sums, LyapunovEstimate& out) {
  const GrowthSums::Totals& t = sums.totals();
  const double duration = sums.window().to - sums.window().from;
  const double m = out.chaotic_share.value * static_cast<double>(t.orbits);
  if (m < 2.0) return;
  const double mean = out.per_time.value * static_cast<double>(t.orbits) / m;
  double error = results::root(
      (t.chaotic_squares.value() / (m * duration * duration) - mean * mean) / (m - 1.0));
  if (!sums.parts().empty())
    error = replicate_error(sums.parts(), numbers_of(t), [&](const Numbers& x) {
      return x.chaotic_growth / (x.chaotic * duration);
    });
  out.chaotic = {mean, both(error, mean * out.hidden_error / out.chaotic_share.value)};
}

// Runs of fewer mean flights do not call the growth of all orbits linear.
constexpr double least_flights = 100.0;

// Which law the growth follows, and what that makes of the means.
void estimate_law(const GrowthSums& sums, bool regular, LyapunovEstimate& out) {
  using Law = LyapunovEstimate::Law;
  const GrowthSums::Totals& t = sums.totals();
  const TimeWindow window = sums.window();
  const double duration = window.to - window.from;
  const auto n = static_cast<double>(t.orbits), found = static_cast<double>(t.chaotic);
  const double flights = t.flights.value() / n, others = n - found;
  const double slow_growth =
      others > 0.0 ? (t.growth.value() - t.chaotic_growth.value()) / others : 0.0;
  const double linear_growth =
      elementary::log((flights + 1.0) / (flights * (window.from / window.to) + 1.0));
  if (const double rate = t.chaotic_growth.value() / (found * duration); found > 0.0 && rate > 0.0)
    out.waiting_time = waiting_time_of(rate, flights / window.to);
  const bool share = out.waiting_time * waiting_times <= window.to;  // false for NaN
  // Linear growth differs from its mean by about 1.5 from orbit to orbit.
  const bool slow = slow_growth <= linear_growth + 0.5 + 4.5 / results::root(std::max(1.0, others));
  if (regular) {
    out.law = Law::linear;
    out.tells_regular = true;
    out.long_enough = true;
    out.per_time = {0.0, 0.0};
    if (std::isfinite(out.per_hit.value)) out.per_hit = {0.0, 0.0};
    out.chaotic_share = {0.0, 0.0};
    out.share_interval = {0.0, 0.0};
    return;
  }
  if (t.chaotic == 0 && slow) {
    out.law = flights >= least_flights ? Law::linear : Law::unknown;
    out.long_enough = true;
    out.per_time = out.per_hit = {nan, nan};
    if (out.law == Law::unknown) return;
    out.tells_regular = true;
    out.would_show = (0.5 * most_of_linear + elementary::log(flights + 1.0)) / window.to;
    out.per_time.value = 0.0;
    if (t.hits.value() > 0.0) out.per_hit.value = 0.0;
    return;
  }
  if (!share) {
    out.regular_bias = others / n * std::min(slow_growth, linear_growth) / duration;
    return;
  }
  out.tells_regular = true;
  estimate_share(sums, out);
  // The linear growth of regular orbits is no exponent. What is not known of their share is an
  // error more.
  const double each = slow_growth / duration, old = out.per_time.value;
  out.per_time.value -= (1.0 - out.chaotic_share.value) * each;
  estimate_chaotic(sums, out);
  double error = both(out.per_time.error, out.chaotic_share.error * each);
  // Blocks of fewer orbits than these do not know that some are regular and others chaotic.
  if (t.orbits < GrowthSums::enough_blocks && others > 0.0 && n > 1.0)
    error = both(error, results::root(found * others / (n - 1.0)) / found * out.per_time.value *
                            student_factor(t.orbits));
  if (old > 0.0) {
    out.per_hit.value *= out.per_time.value / old;
    out.per_hit.error *= error / out.per_time.error;
  }
  out.per_time.error = error;
}

}  // namespace

LyapunovEstimate mean_growth_of(const GrowthSums& sums) {
  LyapunovEstimate out;
  out.per_time = out.per_hit = out.chaotic = out.chaotic_share = {nan, nan};
  out.share_interval = {nan, nan};
  out.waiting_time = nan;
  if (sums.totals().orbits > 0) estimate_means(sums, out);
  return out;
}

LyapunovEstimate estimate_of(const GrowthSums& sums, bool regular) {
  LyapunovEstimate out = mean_growth_of(sums);
  if (sums.totals().orbits > 0) estimate_law(sums, regular, out);
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

double quantile_of(const std::vector<ExponentBin>& bins, double q) {
  std::uint64_t all = 0;
  for (const ExponentBin& bin : bins) all += bin.count;
  const double wanted = q * static_cast<double>(all);
  double below = 0.0;
  for (const ExponentBin& bin : bins) {
    const auto here = static_cast<double>(bin.count);
    if (here > 0.0 && below + here >= wanted)
      return bin.from + (bin.to - bin.from) * std::max(0.0, wanted - below) / here;
    below += here;
  }
  return nan;
}

}  // namespace carom
