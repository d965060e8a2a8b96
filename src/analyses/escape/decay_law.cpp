#include "analyses/escape/decay_law.hpp"

#include <algorithm>
#include <limits>

#include "base/student.hpp"
#include "carom/base/elementary.hpp"

namespace carom::analyses {

namespace {

/// exp(x) - 1 without a loss of digits near 0. Beyond 1/2 the difference is exact and the rounding
/// of exp(x) at most half an ulp of 4 |exp(x) - 1|. Before, eight terms of the series at x / 8
/// leave out less than 2^-54 of it, and e^2x - 1 = g (2 + g) with g = e^x - 1 is doubled back.
double growth_of(double x) {
  if (!(std::fabs(x) < 0.5)) return elementary::exp(x) - 1.0;
  const double h = 0.125 * x;
  double growth = 1.0;
  for (const double inverse : {1.0 / 9, 1.0 / 8, 1.0 / 7, 1.0 / 6, 1.0 / 5, 1.0 / 4, 1.0 / 3, 0.5})
    growth = 1.0 + h * inverse * growth;
  growth *= h;
  for (int doubled = 0; doubled < 3; ++doubled) growth *= 2.0 + growth;
  return growth;
}

/// Most likely rate. `truncated`: nothing is known of those that stay, so only how the times of the
/// others are spread within the window counts. Nothing where they are not denser at its start.
std::optional<Rate> most_likely_rate(std::span<const Cell> cells, double start, double length,
                                     double there, bool truncated, Asked asked) {
  double gone = 0.0, sum = 0.0;
  for (const Cell& cell : cells) {
    gone += cell.count;
    sum += cell.count * (cell.u - start + 0.5 * cell.width);
  }
  if (gone == 0.0 || length <= 0.0) return {};
  if (truncated && sum >= 0.5 * length * gone) return {};
  // The logarithm of the likelihood is concave in the rate: Newton's method, kept within a factor.
  double rate = gone / (sum + (truncated ? 0.0 : there * length)), curvature = 0.0;
  // One factor a step at worst, from a start that is wrong by 2 gone at most; then quadratically.
  constexpr int most_steps = 200;
  for (int step = 0; step < most_steps; ++step) {
    double slope = 0.0;
    curvature = 0.0;
    const auto add = [&](double weight, double width) {
      const double growth = growth_of(rate * width);
      if (std::isinf(growth)) return;
      slope += weight * width / growth;
      curvature += weight * width * width / growth * (1.0 + 1.0 / growth);
    };
    for (const Cell& cell : cells) {
      slope -= cell.count * (cell.u - start);
      add(cell.count, cell.width);
    }
    if (truncated)
      add(-gone, length);
    else
      slope -= there * length;
    if (!(curvature > 0.0)) return {};
    const double before = rate;
    rate = std::clamp(before + slope / curvature, 0.5 * before, 2.0 * before);
    // In units of the error. The next step would change it by far less: Newton's steps square.
    const double last = asked == Asked::evidence ? 1e-8 : 1e-2;
    if (std::fabs(rate - before) * std::sqrt(curvature) < last) break;
  }
  return Rate{rate, 1.0 / std::sqrt(curvature)};
}

/// Pearson's test in cells of about equal expectation. `stay`: expected share at the end.
double p_value(const Seen& seen, double rate, double c, double stay, int fitted) {
  const double all = seen.gone + seen.there;
  // Few cells notice slow deviations best; each expects twenty at least.
  const int most = static_cast<int>(std::clamp(seen.gone / 20.0, 3.0, 24.0));
  const double leave = -growth_of(-rate * seen.length);
  std::vector<double> expected(static_cast<std::size_t>(most)), found(expected.size());
  // Ends of cells lie at those of bins.
  std::size_t next = 0;
  double begun = 0.0;
  const auto close = [&](std::size_t cell, double u) {
    const double until = -growth_of(-rate * u);
    expected[cell] = (1.0 - c) * (until - begun) * all;
    begun = until;
  };
  std::size_t cell = 0;
  for (; next < seen.cells.size(); ++next) {
    const Cell& bin = seen.cells[next];
    const double before = -growth_of(-rate * bin.u) / leave;
    if (cell + 1 < expected.size() &&
        before * static_cast<double>(most) >= static_cast<double>(cell + 1)) {
      close(cell++, bin.u);
    }
    found[cell] += bin.count;
  }
  close(cell++, seen.length);
  expected.resize(cell);
  found.resize(cell);
  if (c == 0.0) {
    expected.push_back(stay * all);
    found.push_back(seen.there);
  }
  double chi_squared = 0.0;
  int cells = 0;
  double small_expected = 0.0, small_found = 0.0;  // what expects too few is added up
  for (std::size_t i = 0; i < expected.size(); ++i) {
    small_expected += expected[i];
    small_found += found[i];
    if (small_expected < 5.0 && i + 1 < expected.size()) continue;
    if (small_expected > 0.0) {
      const double off = small_found - small_expected;
      chi_squared += off * off / small_expected;
      ++cells;
    }
    small_expected = small_found = 0.0;
  }
  const int degrees = cells - 1 - fitted;
  if (degrees < 1) return std::numeric_limits<double>::quiet_NaN();
  return base::chi_squared_beyond(chi_squared, degrees);
}

constexpr double least_p = 0.1;

}  // namespace

std::optional<Halves> halves_of(const Seen& seen, bool truncated, Asked asked) {
  double gone = 0.0;
  std::size_t half = 0;
  while (half < seen.cells.size() && gone < 0.5 * seen.gone) gone += seen.cells[half++].count;
  // A single cell has no rate.
  if (half < 2 || half + 2 > seen.cells.size()) return {};
  const double middle = seen.cells[half].u;
  const std::span<const Cell> all(seen.cells);
  const auto early = most_likely_rate(all.first(half), 0.0, middle, seen.gone - gone + seen.there,
                                      truncated, asked);
  const auto late = most_likely_rate(all.subspan(half), middle, seen.length - middle, seen.there,
                                     truncated, asked);
  constexpr double unlike = std::numeric_limits<double>::infinity();
  if (!early || !late) return Halves{half, gone, {unlike, 1.0}, {0.0, 1.0}};
  return Halves{half, gone, *early, *late};
}

bool may_describe(const Candidate& one) { return one.decay.p_value >= least_p; }

std::optional<Candidate> fit(DecayLaw law, bool with_plateau, const Seen& seen, double a,
                             double at_start, Asked asked) {
  if (with_plateau && seen.there == 0.0) return {};
  const auto rate = most_likely_rate(seen.cells, 0.0, seen.length, seen.there, with_plateau, asked);
  if (!rate) return {};
  const double all = seen.gone + seen.there, stay = elementary::exp(-rate->value * seen.length);
  // With a plateau the share at the end is fitted exactly, whatever the rate.
  const double s = seen.there / all;
  const double c = with_plateau ? (s - stay) / (1.0 - stay) : 0.0;
  if (with_plateau && !(c > 0.0)) return {};
  Decay d;
  d.law = law;
  d.with_plateau = with_plateau;
  d.rate = rate->value;
  d.rate_error = rate->error;
  double log_likelihood =
      seen.there == 0.0
          ? 0.0
          : seen.there * (with_plateau ? elementary::log(s) : -rate->value * seen.length);
  const double log_not_there = elementary::log(1.0 - c);
  for (const Cell& cell :
       asked == Asked::evidence ? std::span<const Cell>(seen.cells) : std::span<const Cell>())
    log_likelihood += cell.count * (log_not_there - rate->value * cell.u +
                                    elementary::log(-growth_of(-rate->value * cell.width)));
  d.evidence = log_likelihood - 0.5 * elementary::log(seen.gone) * (with_plateau ? 2.0 : 1.0);
  // Errors by first order: the share at the start, s and the rate are independent.
  const double lever = law == DecayLaw::exponential ? a : elementary::log(a);
  const double start_variance = (1.0 - at_start) / all;  // of ln at_start
  const double slope = with_plateau ? seen.length * stay / (1.0 - stay) : 0.0;
  d.amplitude = at_start * (1.0 - c) * elementary::exp(lever * d.rate);
  d.amplitude_error =
      d.amplitude * std::sqrt(start_variance + (with_plateau ? s / ((1.0 - s) * all) : 0.0) +
                              square((lever - slope) * d.rate_error));
  if (with_plateau) {
    d.plateau = at_start * c;
    const double variance = s * (1.0 - s) / all / square(1.0 - stay) +
                            square((1.0 - s) * slope / (1.0 - stay) * d.rate_error);
    d.plateau_error = d.plateau * std::sqrt(start_variance + variance / square(c));
  }
  d.p_value = p_value(seen, d.rate, c, stay, 1);
  Candidate one{d, std::numeric_limits<double>::infinity()};
  // Two more fits tell whether it drifts.
  if (may_describe(one) || asked == Asked::evidence) {
    const auto halves = halves_of(seen, with_plateau, asked);
    one.drift = halves ? halves->difference() : 0.0;
  }
  return one;
}

Seen seen_in(std::span<const EscapeTimes::Bin> bins, double end, double there, DecayLaw law) {
  const double a = bins.front().from;
  Seen seen;
  const auto coordinate = [&](double t) {
    return law == DecayLaw::exponential ? t - a : elementary::log(t / a);
  };
  seen.length = coordinate(end);
  seen.there = there;
  double until = std::numeric_limits<double>::quiet_NaN(), last = 0.0;  // of the bin before
  for (const EscapeTimes::Bin& bin : bins) {
    if (bin.count == 0) continue;
    const double u = bin.from == until ? last : coordinate(bin.from);
    until = std::min(bin.to, end);
    last = coordinate(until);
    seen.cells.push_back({u, last - u, static_cast<double>(bin.count)});
    seen.gone += static_cast<double>(bin.count);
  }
  return seen;
}

}  // namespace carom::analyses
