// The rate at which survival falls between two reports.
#pragma once

#include <cstddef>

#include "carom/analyses/splitting.hpp"
#include "carom/analyses/splitting/fit.hpp"

namespace carom {

/// That of the exponential law from report `first` to report `last`.
inline Extrapolated decay_rate(const SplittingResult& result, std::size_t first, std::size_t last) {
  for (const SplitDecay& decay :
       fit_decay(result, DecayWindow{result.at[first], result.at[last]}).decays)
    if (decay.law == DecayLaw::exponential) return decay.rate;
  return {};
}

}  // namespace carom
