// How survival decays that population splitting found: the laws of carom/analyses/escape/decay.hpp
// without a plateau. docs/physics/decay.md derives the estimators and their errors.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "carom/analyses/escape/decay.hpp"
#include "carom/analyses/splitting.hpp"

namespace carom {

/// One law. Values at different reports come from the same populations: every error is taken from
/// the scatter of a whole quantity between repetitions, so that correlations are in it.
struct SplitDecay {
  DecayLaw law = DecayLaw::exponential;
  Extrapolated rate;  ///< 1/time, 1/hit or the exponent of a power
  double amplitude = 0.0, amplitude_error = 0.0;
  bool local = false;  ///< the slope in this window, which is too short to show a law
  /// How likely the rates before and after some report within differ by as much, if the law holds
  /// (Student's t, paired by repetitions; the least p-value times the number of reports within);
  /// NaN with less than three reports.
  double p_value = 0.0;
  /// Logarithm of the likelihood of that difference at the window's middle; 0 where it is NaN.
  double evidence = 0.0;
};

struct SplitFit {
  double from = 0.0, to = 0.0;     ///< the window, from report to report
  std::vector<SplitDecay> decays;  ///< the likelier first; none if `why_none` says why
  /// The first is at least twenty times as likely as the second, and its p-value is not below 0.01.
  bool decided = false;
  std::string why_none;
};

/// The decay between the first and the last report of a window; without one of the second half of
/// the reports at which some population had survivors.
SplitFit fit_decay(const SplittingResult&, std::optional<DecayWindow> window = {});

}  // namespace carom
