#include "carom/analyses/escape/decay.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "analyses/escape/decay_law.hpp"
#include "carom/analyses/escape.hpp"
#include "carom/base/elementary.hpp"
#include "carom/results/interval.hpp"

namespace carom {

using namespace analyses;

namespace {

// One in a hundred of the true laws is called refuted.
constexpr double refuted_p = 0.01;
constexpr double largest_drift = 1.0;
// What a power without a plateau drifts by is allowed for.
constexpr double largest_drift_of_power = 1.5;
// Halves of the window itself, once in twenty.
constexpr double refuted_drift = 2.0;

bool plain_power(const Decay& decay) { return decay.law == DecayLaw::power && !decay.with_plateau; }

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

// Exponents from here to 1 may be those of 1/t with a logarithm, as of rectangles with a hole.
constexpr double like_a_logarithm = 0.75;

/// Is the rate that of the window, and no more? What a power differs by at first dies away as a
/// power, too: it has to have held within the window, and before one that was chosen here.
bool is_local(const Candidate& one, const Data& data, const Window& window, bool chosen) {
  const Decay& decay = one.decay;
  const double from = data.bins[window.first].from;
  if (too_short_to_show(decay.law, decay.rate, from, data.end)) return true;
  if (decay.law == DecayLaw::exponential) return false;
  // (A + B ln t) / t falls with the exponent 1 - B / (A + B ln t), in no window a law of its own.
  if (plain_power(decay) && decay.rate > like_a_logarithm &&
      decay.rate + 2.0 * decay.rate_error < 1.0)
    return true;
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
    "fits need independent starts (kind = \"uniform\"), and quasi-random starts are not";

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
    return no_fit("trajectories ended by the cap on hits would have stayed for an unknown time");
  return fit_decay(counts.gone_at, counts.followed(), counts.survived, until, window);
}

DecayFit decay_of(const System& system, const EscapeResult& result) {
  return fit_decay(result.counts, system.run.t_max, system.run.window);
}

}  // namespace carom
