// Means over the repetitions of a splitting, and their limits for vanishing kicks.
#pragma once

#include <cstddef>
#include <functional>

#include "carom/analyses/splitting.hpp"

namespace carom::analyses {

/// The limit of a quantity; `of(kick, r)` is the quantity in repetition r.
Extrapolated extrapolated(const SplittingResult&,
                          const std::function<double(std::size_t, std::size_t)>& of);
/// The error that kicks certainly make between two reports; `from` == `to`: since the start. Copies
/// show only the error of trajectories that go before the next level, measured to be half of all.
double kick_error(const SplittingResult&, std::size_t from, std::size_t to);

}  // namespace carom::analyses
