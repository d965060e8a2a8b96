#include "validation/rounding/paired_survival.hpp"

#include <algorithm>
#include <cmath>

#include "carom/base/random.hpp"

namespace carom {

namespace {

constexpr double four_in_five = 0.8416212335729143,
                 both_sides = 1.959963984540054;  // normal quantiles

// The bias, in pairs, beside n pairs that disagree by chance: it lies `threshold` and some more of
// its own errors from zero, and its pairs disagree too.
double found_in_four_of_five(double n, double threshold) {
  const double k = std::max(threshold, both_sides) + four_in_five;
  return 0.5 * (k * k + std::sqrt(k * k * (k * k + 4.0 * n)));
}

// Differences of counts at each time, from the pairs' signs.
template <class Sign, class Pairs>
void sum_signs(const Pairs& pairs, Sign sign, std::vector<std::int64_t>& sums) {
  std::fill(sums.begin(), sums.end(), 0);
  for (const auto& pair : pairs) {
    const std::int64_t s = sign(pair);
    sums[pair.from] += s;
    sums[pair.to] -= s;
  }
  for (std::size_t k = 1; k < sums.size(); ++k) sums[k] += sums[k - 1];
}

}  // namespace

void PairedSurvival::add(const PairedEnd& first, const PairedEnd& second) {
  gone_first_.resize(times_.size() + 1);
  gone_second_.resize(times_.size() + 1);
  ++pairs_;
  const bool gone = std::isfinite(first.time), both = gone && std::isfinite(second.time);
  if (gone != std::isfinite(second.time) || (both && first.hole != second.hole))
    ++other_hole_;
  else if (both && first.hits != second.hits)
    ++other_hits_;
  else if (both && std::fabs(first.time - second.time) > tolerance_)
    ++other_time_;
  // A trajectory that ends exactly at t has gone by t.
  const auto index = [&](double t) {
    return static_cast<std::uint32_t>(std::lower_bound(times_.begin(), times_.end(), t) -
                                      times_.begin());
  };
  const std::uint32_t a = index(first.time), b = index(second.time);
  ++gone_first_[a];
  ++gone_second_[b];
  if (a != b) disagreements_.push_back({std::min(a, b), std::max(a, b), a > b});
}

PairedResult PairedSurvival::result(std::uint64_t seed, std::uint64_t swaps) const {
  PairedResult r;
  r.pairs = pairs_;
  r.other_hole = other_hole_;
  r.other_hits = other_hits_;
  r.other_time = other_time_;
  r.swaps = swaps;
  if (pairs_ == 0) return r;
  const double all = static_cast<double>(pairs_);
  std::vector<std::int64_t> difference(times_.size() + 1), number(times_.size() + 1),
      swapped(times_.size() + 1);
  sum_signs(
      disagreements_, [](const Disagreement& d) { return d.first ? 1 : -1; }, difference);
  sum_signs(
      disagreements_, [](const Disagreement&) { return 1; }, number);

  // The spread of a difference under swaps is the root of the number that can be swapped.
  std::vector<double> weight;
  for (std::size_t k = 0; k < times_.size(); ++k)
    weight.push_back(number[k] > 0 ? 1.0 / std::sqrt(static_cast<double>(number[k])) : 0.0);
  const auto largest = [&](const std::vector<std::int64_t>& sums) {
    double most = 0.0;
    for (std::size_t k = 0; k < times_.size(); ++k)
      most = std::max(most, std::fabs(static_cast<double>(sums[k])) * weight[k]);
    return most;
  };
  r.statistic = largest(difference);
  std::vector<double> most;
  std::uint64_t as_large = 0;
  for (std::uint64_t s = 0; s < swaps; ++s) {
    RandomStream random(seed, Purpose::swap_test, s);
    std::uint64_t bits = 0;
    int left = 0;
    const auto toss = [&](const Disagreement&) {
      if (left == 0) bits = random.word(), left = 64;
      const std::int64_t sign = (bits & 1) != 0 ? 1 : -1;
      bits >>= 1;
      --left;
      return sign;
    };
    sum_signs(disagreements_, toss, swapped);
    most.push_back(largest(swapped));
    // Equal up to rounding is as large.
    if (most.back() >= r.statistic * (1.0 - 1e-12)) ++as_large;
  }
  r.p_value = static_cast<double>(1 + as_large) / static_cast<double>(1 + swaps);
  std::sort(most.begin(), most.end());
  if (!most.empty())
    r.threshold = most[std::min(most.size() - 1, static_cast<std::size_t>(std::ceil(
                                                     0.95 * static_cast<double>(most.size()))))];

  std::uint64_t gone_first = 0, gone_second = 0;
  for (std::size_t k = 0; k < times_.size(); ++k) {
    gone_first += gone_first_[k];
    gone_second += gone_second_[k];
    PairedPoint p;
    p.t = times_[k];
    p.first = static_cast<double>(pairs_ - gone_first) / all;
    p.second = static_cast<double>(pairs_ - gone_second) / all;
    const double d = static_cast<double>(difference[k]), n = static_cast<double>(number[k]);
    p.difference = d / all;
    p.error = std::sqrt(n - d * d / all) / all;
    p.only_first = static_cast<std::uint64_t>((number[k] + difference[k]) / 2);
    p.only_second = static_cast<std::uint64_t>((number[k] - difference[k]) / 2);
    p.detectable = found_in_four_of_five(n, r.threshold) / all;
    r.points.push_back(p);
  }
  return r;
}

}  // namespace carom
