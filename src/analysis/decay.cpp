#include "carom/analysis/decay.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "base/chi_squared.hpp"
#include "carom/analysis/interval.hpp"
#include "carom/base/elementary.hpp"

namespace carom {

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

// With u = t - a, or ln(t / a), from the start a of the window, both laws are
//   P(u) / P(0) = (1 - c) exp(-rate u) + c.
struct Cell {
  double u, width, count;
};
/// What is seen of those that are there at the start of the window.
struct Seen {
  std::vector<Cell> cells;         ///< without those that are empty
  double length = 0.0;             ///< of the window
  double gone = 0.0, there = 0.0;  ///< in the window, and at its end
};

/// What is asked of a fit: whether it describes the escapes, or also its evidence beside others.
enum class Asked : unsigned char { description, evidence };

struct Rate {
  double value, error;
};

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

double square(double x) { return x * x; }

/// The rates of the earlier and the later half of the escapes, fitted apart: independent.
struct Halves {
  std::size_t late_from;  ///< cell
  double gone_early;
  Rate early, late;
  /// In standard errors.
  double difference() const {
    return std::fabs(early.value - late.value) /
           std::sqrt(square(early.error) + square(late.error));
  }
};
/// `truncated` as of most_likely_rate: that is all that a law with a plateau says of a part.
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

constexpr double least_p = 0.1;
// One in a hundred of the true laws is called refuted.
constexpr double refuted_p = 0.01;
constexpr double largest_drift = 1.0;
// What a power without a plateau drifts by is allowed for.
constexpr double largest_drift_of_power = 1.5;
// Halves of the window itself, once in twenty.
constexpr double refuted_drift = 2.0;

struct Candidate {
  Decay decay;
  double drift;  ///< infinite where the test of the decay has failed and no more is asked
};
bool may_describe(const Candidate& one) { return one.decay.p_value >= least_p; }
bool plain_power(const Decay& decay) { return decay.law == DecayLaw::power && !decay.with_plateau; }

/// `at_start`: share of all that is there at the start a of the window.
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

/// Bins as cells of u.
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

/// What all windows of some data have in common.
struct Data {
  std::span<const EscapeTimes::Bin> bins;
  double end, there, particles;
  bool plateau;  ///< may one be fitted?
};

/// From a bin on. Where evidence is asked for, the best first.
std::vector<Candidate> all_fits(const Data& data, std::size_t first, Asked asked) {
  const auto bins = data.bins.subspan(first);
  std::vector<Candidate> found;
  for (const DecayLaw law : {DecayLaw::exponential, DecayLaw::power}) {
    const Seen seen = seen_in(bins, data.end, data.there, law);
    const double at_start = (seen.gone + data.there) / data.particles;
    for (const bool with_plateau : {false, true}) {
      if (with_plateau && !data.plateau) continue;
      if (const auto one = fit(law, with_plateau, seen, bins.front().from, at_start, asked))
        found.push_back(*one);
    }
  }
  if (asked == Asked::description) return found;
  std::stable_sort(found.begin(), found.end(), [](const Candidate& x, const Candidate& y) {
    return x.decay.evidence > y.decay.evidence;
  });
  return found;
}

// Fewer escapes tell no law from another.
constexpr double fewest = 100.0;
constexpr double share_of_escapes = 0.2;
// ln 20
constexpr double decisive = 2.995732273553991;
// Starts that are tried lie a factor of 2^(1/4) apart.
constexpr std::size_t between_starts = 16;

bool describes(const Candidate& one) {
  return may_describe(one) &&
         one.drift < (plain_power(one.decay) ? largest_drift_of_power : largest_drift);
}

double count_of(std::span<const EscapeTimes::Bin> bins) {
  double sum = 0.0;
  for (const EscapeTimes::Bin& bin : bins) sum += static_cast<double>(bin.count);
  return sum;
}

// A plateau is fitted where P falls more slowly than t to minus this power at the end.
constexpr double slow = 0.5;

/// Does the end of the data show a plateau by itself? An exponential that goes over into a power
/// looks like one that goes over into a plateau; but there P falls on.
bool shows_plateau(std::span<const EscapeTimes::Bin> bins, double end, double there) {
  const double from = std::max(bins.front().from, 0.5 * end);
  double gone = 0.0;
  for (const EscapeTimes::Bin& bin : bins)
    if (bin.from >= from) gone += static_cast<double>(bin.count);
  const auto leave =
      wilson_interval(static_cast<std::uint64_t>(gone), static_cast<std::uint64_t>(gone + there));
  return leave.high < 1.0 - elementary::exp(-slow * elementary::log(end / from));
}

/// The latest window that the data allow.
struct Window {
  /// Bins: a law describes all from the first, and those of the window are fitted. The number of
  /// bins if there is no window.
  std::size_t described, first;
  std::vector<Candidate> fits;  ///< the best first
};

Window latest_window(const Data& data) {
  const auto& bins = data.bins;
  for (std::size_t i = 0; i < bins.size(); i += between_starts) {
    const double escapes = count_of(bins.subspan(i));
    if (escapes < fewest) break;
    if (std::ranges::none_of(all_fits(data, i, Asked::description), describes)) continue;
    const double wanted = std::max(fewest, share_of_escapes * escapes);
    double left = escapes;
    std::size_t first = i;
    while (left - static_cast<double>(bins[first].count) >= wanted)
      left -= static_cast<double>(bins[first++].count);
    // A law may describe all of these and still not the last of them.
    Window found{i, first, all_fits(data, first, Asked::evidence)};
    if (found.fits.empty() || found.fits[0].decay.p_value >= refuted_p) return found;
  }
  return {bins.size(), bins.size(), {}};
}

// Where a plateau is fitted from the same escapes, a power is seen over a decade.
constexpr double beside_a_plateau = 10.0;
// So that the window, a fifth of them, has left most of the beginning behind.
constexpr double least_described = 1000.0;

/// Is the rate that of the window, and no more? What a power differs by at first dies away as a
/// power, too: it has to have held within the window, and before one that was chosen here.
bool is_local(const Candidate& one, const Data& data, const Window& window, bool chosen) {
  const Decay& decay = one.decay;
  const double from = data.bins[window.first].from;
  if (too_short_to_show(decay.law, decay.rate, from, data.end)) return true;
  if (decay.law == DecayLaw::exponential) return false;
  return (decay.with_plateau && data.end < beside_a_plateau * from) || one.drift > refuted_drift ||
         (chosen && count_of(data.bins.subspan(window.described)) < least_described);
}

double mean_inverse_time(std::span<const Cell> cells, double a) {
  double sum = 0.0, gone = 0.0;
  for (const Cell& cell : cells) {
    sum += cell.count * elementary::exp(-(cell.u + 0.5 * cell.width)) / a;
    gone += cell.count;
  }
  return sum / gone;
}

/// A power of t + t0 with t0 unknown, to first order in t0 / t: what is described tells t0 by the
/// change of the exponent within it, with an error that goes into those of the exponent and A.
void allow_for_origin(Decay& power, const Data& data, const Window& window) {
  const double a = data.bins[window.described].from;
  const Seen seen = seen_in(data.bins.subspan(window.described), data.end, data.there, power.law);
  const auto halves = halves_of(seen, false, Asked::evidence);
  if (!halves || std::isinf(halves->early.value)) return;
  const std::span<const Cell> cells(seen.cells);
  const double start = data.bins[window.first].from;
  const double u_start = elementary::log(start / a);
  std::size_t used_from = 0;
  while (used_from < cells.size() && cells[used_from].u + 0.5 * cells[used_from].width < u_start)
    ++used_from;
  const auto used = cells.subspan(used_from);
  const double apart = mean_inverse_time(cells.first(halves->late_from), a) -
                       mean_inverse_time(cells.subspan(halves->late_from), a);
  const double at = mean_inverse_time(used, a);
  // At t the exponent is a - s / t with s = a t0. Only differences within a bound are accepted: as
  // if all of them were alike, the variance is a third of the bound's square.
  constexpr double accepted = largest_drift_of_power * largest_drift_of_power / 3.0;
  const double s = (halves->late.value - halves->early.value) / apart;
  const double s_variance =
      accepted * (square(halves->early.error) + square(halves->late.error)) / square(apart);
  // Of rates of overlapping windows the covariance is rate^2 n / (n1 n2), n in both.
  double gone = 0.0, both = 0.0;
  for (const Cell& cell : used) {
    gone += cell.count;
    if (cell.u >= cells[halves->late_from].u) both += cell.count;
  }
  const double covariance =
      accepted * square(power.rate) / gone / apart *
      (both / (seen.gone - halves->gone_early) - (gone - both) / halves->gone_early);
  const double lever = elementary::log(start), slope = at * lever + 1.0 / start;
  const auto with = [](double error, double more) {
    return std::sqrt(square(error) + std::max(more, 0.0));
  };
  const double log_error = with(power.amplitude_error / power.amplitude,
                                2.0 * lever * slope * covariance + square(slope) * s_variance);
  power.amplitude *= elementary::exp(slope * s);
  power.amplitude_error = power.amplitude * log_error;
  power.rate += at * s;
  power.rate_error = with(power.rate_error, 2.0 * at * covariance + square(at) * s_variance);
}

}  // namespace

bool too_short_to_show(DecayLaw law, double rate, double from, double to) {
  constexpr double ln3 = 1.0986122886681098;
  return law == DecayLaw::exponential ? rate * (to - from) < ln3 : to < 2.0 * from;
}

double odds(const Decay& one, const Decay& against) {
  return elementary::exp(one.evidence - against.evidence);
}

std::string name_of(const Decay& decay) {
  return std::string(decay.law == DecayLaw::exponential ? "exponential" : "power") +
         (decay.with_plateau ? " + plateau" : "");
}

namespace {

DecayFit fit_bins(std::vector<EscapeTimes::Bin> bins, std::uint64_t particles,
                  std::uint64_t still_there, double until, std::optional<DecayWindow> window) {
  DecayFit result;
  double there = static_cast<double>(still_there), end = until;
  if (window) {
    while (!bins.empty() && !(bins.back().from < window->second)) {
      there += static_cast<double>(bins.back().count);
      bins.pop_back();
    }
    bins.erase(bins.begin(), std::find_if(bins.begin(), bins.end(),
                                          [&](const auto& bin) { return bin.to > window->first; }));
    end = std::min(until, EscapeTimes::bin_of(window->second).from);
    if (end < window->second) end = std::min(until, EscapeTimes::bin_of(window->second).to);
  }
  const double all = static_cast<double>(particles);
  if (count_of(bins) < fewest) {
    result.why_none = window ? "fewer than 100 escapes in the window" : "fewer than 100 escapes";
    return result;
  }
  const Data data{bins, end, there, all, shows_plateau(bins, end, there)};
  const Window chosen =
      window ? Window{0, 0, all_fits(data, 0, Asked::evidence)} : latest_window(data);
  if (chosen.first == bins.size()) {
    result.why_none = "no law describes the last 100 escapes";
    return result;
  }
  for (const Candidate& one : chosen.fits) {
    Decay decay = one.decay;
    decay.local = is_local(one, data, chosen, !window);
    if (!window && !decay.local && plain_power(decay)) allow_for_origin(decay, data, chosen);
    result.decays.push_back(decay);
  }
  if (result.decays.empty()) {
    result.why_none = "the escapes do not become rarer";
    return result;
  }
  const auto used = std::span(bins).subspan(chosen.first);
  result.from = used.front().from;
  result.to = end;
  result.escapes = static_cast<std::uint64_t>(count_of(used));
  result.decided =
      result.decays.size() == 1 || result.decays[0].evidence - result.decays[1].evidence > decisive;
  return result;
}

/// Hits are whole numbers: bins begin and end at them. Those between two whole numbers are empty.
EscapeTimes::Bin whole(const EscapeTimes::Bin& bin) {
  return {std::ceil(bin.from), std::ceil(bin.to), bin.count};
}
/// The last number of hits up to which it is known of all when they are gone, or a little less.
double known_until(const SurvivalCounts& counts) {
  if (counts.survived == counts.pinned) return std::numeric_limits<double>::infinity();
  const std::uint64_t last = counts.fewest_hits_of_survivor;
  return last == 0 ? 0.0 : whole(EscapeTimes::bin_of(static_cast<double>(last))).from;
}

DecayFit no_fit(const char* why) {
  DecayFit none;
  none.why_none = why;
  return none;
}
constexpr const char* dependent =
    "fits take independent starts (kind = \"uniform\"), and quasi-random ones are not";

}  // namespace

DecayFit fit_decay(const EscapeTimes& times, std::uint64_t particles, std::uint64_t still_there,
                   double until, std::optional<DecayWindow> window) {
  return fit_bins(times.bins(), particles, still_there, until, window);
}

DecayFit fit_decay_by_hits(const SurvivalCounts& counts) {
  if (!counts.parts.empty()) return no_fit(dependent);
  const double until = known_until(counts);
  std::vector<EscapeTimes::Bin> bins;
  std::uint64_t there = counts.survived;
  for (const EscapeTimes::Bin& bin : counts.gone_after.bins()) {
    if (bin.from < until)
      bins.push_back(whole(bin));
    else
      there += bin.count;
  }
  const double end = bins.empty() ? 0.0 : std::min(until, bins.back().to);
  return fit_bins(std::move(bins), counts.followed(), there, end, {});
}

DecayFit fit_decay(const SurvivalCounts& counts, double until, std::optional<DecayWindow> window) {
  if (!counts.parts.empty()) return no_fit(dependent);
  if (counts.capped > 0)
    return no_fit("trajectories ended by the cap on hits would have stayed for unknown times");
  return fit_decay(counts.gone_at, counts.followed(), counts.survived, until, window);
}

}  // namespace carom
