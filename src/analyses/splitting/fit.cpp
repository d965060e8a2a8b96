#include "carom/analyses/splitting/fit.hpp"

#include <algorithm>
#include <cmath>

#include "analyses/splitting/means.hpp"
#include "base/student.hpp"
#include "carom/base/elementary.hpp"

namespace carom {

using namespace analyses;

namespace {

// ln 20, as in the fit of ensembles.
constexpr double decisive = 2.995732273553991;
// A p-value below which no law is decided for, as in the fit of ensembles.
constexpr double refuted = 0.01;

/// Logarithms of survival at reports, to first order in what a repetition differs from the mean by:
/// a mean of logarithms would be off by the variance of a population.
class Logarithms {
 public:
  explicit Logarithms(const SplittingResult& result) : result_(result) {
    for (std::size_t i = 0; i < result.at.size(); ++i)
      means_.push_back(extrapolated(result, [&](std::size_t k, std::size_t r) {
                         return result.runs[k][r].survival[i];
                       }).at_kick);
  }
  double operator()(std::size_t kick, std::size_t repetition, std::size_t report) const {
    const double mean = means_[report][kick].value;
    return elementary::log(mean) + result_.runs[kick][repetition].survival[report] / mean - 1.0;
  }
  bool known(std::size_t report) const {
    return std::all_of(means_[report].begin(), means_[report].end(),
                       [](const Mean& mean) { return mean.value > 0.0; });
  }

 private:
  const SplittingResult& result_;
  std::vector<std::array<Mean, kick_sizes>> means_;
};

/// Reports first … last.
struct Span {
  std::size_t first, last;
};

/// ln P falls by the rate a unit of this coordinate.
double coordinate(DecayLaw law, double at) {
  return law == DecayLaw::exponential ? at : elementary::log(at);
}

Extrapolated rate_of(const SplittingResult& result, const Logarithms& ln_p, DecayLaw law,
                     Span span) {
  const double width =
      coordinate(law, result.at[span.last]) - coordinate(law, result.at[span.first]);
  Extrapolated rate = extrapolated(result, [&](std::size_t k, std::size_t r) {
    return (ln_p(k, r, span.first) - ln_p(k, r, span.last)) / width;
  });
  rate.kick_error = kick_error(result, span.first, span.last) / width;
  return rate;
}

SplitDecay fit(const SplittingResult& result, const Logarithms& ln_p, DecayLaw law, Span span) {
  const auto u = [&](std::size_t i) { return coordinate(law, result.at[i]); };
  const auto slope = [&](std::size_t k, std::size_t r, std::size_t i, std::size_t j) {
    return (ln_p(k, r, i) - ln_p(k, r, j)) / (u(j) - u(i));
  };
  SplitDecay decay;
  decay.law = law;
  decay.rate = rate_of(result, ln_p, law, span);
  const Mean amplitude =
      extrapolated(result, [&](std::size_t k, std::size_t r) {
        return ln_p(k, r, span.first) + u(span.first) * slope(k, r, span.first, span.last);
      }).limit;
  decay.amplitude = elementary::exp(amplitude.value);
  decay.amplitude_error = decay.amplitude * amplitude.error;
  decay.local =
      too_short_to_show(law, decay.rate.limit.value, result.at[span.first], result.at[span.last]);
  decay.p_value = std::nan("");
  std::size_t middle = span.first + 1;
  while (middle + 1 < span.last && u(middle) < 0.5 * (u(span.first) + u(span.last))) ++middle;
  // Survival in steps may have equal slopes in both halves, so every report within is asked. Their
  // p-values depend on each other; the least of them times their number is safe (Bonferroni).
  double least = 1.0;
  for (std::size_t m = span.first + 1; m < span.last; ++m) {
    const Extrapolated change = extrapolated(result, [&](std::size_t k, std::size_t r) {
      return slope(k, r, span.first, m) - slope(k, r, m, span.last);
    });
    if (change.repetitions < 2 || !(change.limit.error > 0.0)) continue;
    const double degrees = static_cast<double>(change.repetitions - 1);
    const double t = change.limit.value / change.limit.error;
    least = std::min(least, base::student_beyond(t, degrees));
    decay.p_value = std::min(1.0, least * static_cast<double>(span.last - span.first - 1));
    // The density of Student's t at this difference, over that at none.
    if (m == middle)
      decay.evidence = -0.5 * (degrees + 1.0) * elementary::log(1.0 + t * t / degrees);
  }
  return decay;
}

// Reports that tell the decay from the start.
constexpr std::size_t fewest_reports = 4;

std::string why_not(const SplittingResult& result, Span span, std::size_t known, bool window) {
  if (result.runs.front().size() < 2) return "fewer than two repetitions give no error";
  if (!window && known < fewest_reports) return "fewer than four reports with survivors";
  if (span.last <= span.first) return "fewer than two reports with survivors in the window";
  return {};
}

}  // namespace

SplitFit fit_decay(const SplittingResult& result, std::optional<DecayWindow> window) {
  SplitFit made;
  const Logarithms ln_p(result);
  std::size_t known = 0;
  while (known < result.at.size() && ln_p.known(known)) ++known;
  Span span{known / 2, known == 0 ? 0 : known - 1};
  if (window) {
    span.first = static_cast<std::size_t>(
        std::lower_bound(result.at.begin(), result.at.end(), window->first) - result.at.begin());
    const auto end = std::upper_bound(result.at.begin(), result.at.end(), window->second);
    span.last = std::min<std::size_t>(
        span.last,
        end == result.at.begin() ? 0 : static_cast<std::size_t>(end - result.at.begin()) - 1);
  }
  made.why_none = why_not(result, span, known, window.has_value());
  if (!made.why_none.empty()) return made;
  made.from = result.at[span.first];
  made.to = result.at[span.last];
  for (const DecayLaw law : {DecayLaw::exponential, DecayLaw::power}) {
    if (law == DecayLaw::power && !(made.from > 0.0)) continue;
    SplitDecay decay = fit(result, ln_p, law, span);
    if (std::isfinite(decay.rate.limit.value)) made.decays.push_back(std::move(decay));
  }
  if (made.decays.empty()) {
    made.why_none = "the populations died out in the window";
    return made;
  }
  std::stable_sort(
      made.decays.begin(), made.decays.end(),
      [](const SplitDecay& x, const SplitDecay& y) { return x.evidence > y.evidence; });
  made.decided =
      !(made.decays[0].p_value < refuted) &&
      (made.decays.size() == 1 || made.decays[0].evidence - made.decays[1].evidence > decisive);
  return made;
}

}  // namespace carom
