// How a survival probability decays: exponentially or as a power, with or without a share that
// stays, by maximum likelihood. docs/physics/decay.md derives the estimators and their errors.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "carom/analyses/escape/survival.hpp"

namespace carom {

enum class DecayLaw {
  exponential,  ///< P(t) = A exp(-rate t) + plateau
  power         ///< P(t) = A t^-rate + plateau
};

/// One law with its most likely numbers. Errors are standard errors; an interval of 95 % is the
/// value and 1.96 of them to either side.
struct Decay {
  DecayLaw law = DecayLaw::exponential;
  bool with_plateau = false;            ///< else the plateau is 0
  double rate = 0.0, rate_error = 0.0;  ///< 1/time, or the exponent of a power
  double amplitude = 0.0, amplitude_error = 0.0;
  double plateau = 0.0, plateau_error = 0.0;  ///< share of all that never leaves
  /// The window is too short to show a law, or too few escapes lead to it: the rate is the slope in
  /// this window, and no more.
  bool local = false;
  /// How likely counts are that lie as far from this law as those found (Pearson's chi squared).
  double p_value = 0.0;
  /// Logarithm of the likelihood less half the logarithm of the number of escapes for each number
  /// that was fitted (Schwarz 1978): laws with fewer numbers to fit are preferred.
  double evidence = 0.0;
};
/// "exponential", "power", "exponential + plateau" or "power + plateau".
std::string name_of(const Decay&);
/// How many times as likely the data are under one law as under another, by their evidence.
double odds(const Decay& one, const Decay& against);

/// Is a window too short to show a law by itself? An exponential of this rate is seen by how far it
/// falls, to a third; a power by how the time grows, to twice its start.
bool too_short_to_show(DecayLaw law, double rate, double from, double to);

struct DecayFit {
  double from = 0.0, to = 0.0;  ///< the window
  std::uint64_t escapes = 0;    ///< in it
  std::vector<Decay> decays;    ///< the likeliest first; none if `why_none` says why
  /// The first is at least twenty times as likely as the second.
  bool decided = false;
  std::string why_none;
};

/// First and last time of a window.
using DecayWindow = std::pair<double, double>;

/// Of `particles` in all, `still_there` at `until`; the times of the others are `times`. Particles
/// are independent. Without a window it begins as late as the data allow and ends at `until`: the
/// earliest start is sought at which a law describes all that follows and its rate does not change
/// between the earlier and the later half of the escapes; the fit takes the last 0.2 of these
/// escapes, so that what was too weak to be seen has died away further. A window is widened to
/// whole bins. A plateau is fitted only where the end of the data shows it by itself.
DecayFit fit_decay(const EscapeTimes& times, std::uint64_t particles, std::uint64_t still_there,
                   double until, std::optional<DecayWindow> window = {});

/// The same by number of hits: of P(n), the share that is not gone within n hits. It ends before
/// the fewest hits of a trajectory that is still there at the end, for it is not known when that
/// one goes.
DecayFit fit_decay_by_hits(const SurvivalCounts&);

/// The same of an ensemble that was followed until that time. Particles that were ended by a cap on
/// hits leave unknown how long they would have stayed, and quasi-random starts are not independent:
/// then there is no fit.
DecayFit fit_decay(const SurvivalCounts&, double until, std::optional<DecayWindow> window = {});

}  // namespace carom
