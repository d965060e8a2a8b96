// The most likely numbers of one law of decay in one window. docs/physics/decay.md derives them.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "carom/analyses/escape/decay.hpp"

namespace carom::analyses {

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

/// Bins as cells of u.
Seen seen_in(std::span<const EscapeTimes::Bin> bins, double end, double there, DecayLaw law);

inline double square(double x) { return x * x; }

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
/// `truncated`: nothing is known of those that stay, which is all that a law with a plateau says of
/// a part. Nothing where a half is a single cell.
std::optional<Halves> halves_of(const Seen& seen, bool truncated, Asked asked);

struct Candidate {
  Decay decay;
  double drift;  ///< infinite where the test of the decay has failed and no more is asked
};
/// Is it no worse than one in ten of the true laws?
bool may_describe(const Candidate& one);
/// `at_start`: share of all that is there at the start a of the window.
std::optional<Candidate> fit(DecayLaw law, bool with_plateau, const Seen& seen, double a,
                             double at_start, Asked asked);

}  // namespace carom::analyses
