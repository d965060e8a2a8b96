// What the growth of deviations says of orbits: Lyapunov exponents with their errors, their
// distribution, and which orbits are chaotic. docs/physics/lyapunov.md derives the estimators.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "carom/analysis/interval.hpp"
#include "carom/analysis/mean_square_displacement.hpp"
#include "carom/base/exact_sum.hpp"

namespace carom {

/// How many numbers fall into bins of one width, at most `most` of them. The width is a power of
/// two that doubles as the numbers spread, so the bins are a function of the numbers alone: of
/// neither their order nor how they were merged.
class GrowingHistogram {
 public:
  static constexpr std::size_t most = 256;
  static constexpr int finest = -10;  ///< no bin is narrower than 2^finest

  /// x: finite, of a size below 2^52 finest widths.
  void add(double x, std::uint64_t count = 1);
  void merge(const GrowingHistogram&);

  int exponent() const { return exponent_; }     ///< the width is 2^exponent
  std::int64_t first() const { return first_; }  ///< bin i begins at (first + i) width
  const std::vector<std::uint64_t>& counts() const { return counts_; }
  static GrowingHistogram from(int exponent, std::int64_t first, std::vector<std::uint64_t> counts);

 private:
  void reach(std::int64_t from, std::int64_t to);
  void widen();

  int exponent_ = finest;
  std::int64_t first_ = 0;
  std::vector<std::uint64_t> counts_;
};

/// Regular or chaotic, by how far two deviations have turned into one direction (SALI, in two
/// dimensions GALI_2): their area is kept, so its logarithm is minus that of the product of their
/// lengths.
enum class Regularity : unsigned char { regular, chaotic, undecided };
/// `spread`: the logarithm of that product, which was 1 at the start; after that many mean flights,
/// or other natural times. On an invariant curve it grows as 2 ln flights, and in the chaotic sea
/// as twice the exponent times the time.
Regularity regularity_of(double spread, double flights);
/// SALI itself: the shorter of sum and difference of the two deviations, each of length 1.
double sali_of(double spread);

/// What one orbit gave.
struct OrbitGrowth {
  std::vector<double> growth;                     ///< of ln|w| in each block of the window
  std::vector<std::uint64_t> hits;                ///< in each
  Regularity regularity = Regularity::undecided;  ///< at the window's end
  std::size_t look = 0;                           ///< the first look at which it was chaotic
};

/// Sums over orbits that were followed to the end of the window.
class GrowthSums {
 public:
  /// Times at which orbits are looked at for chaos: the end of the window, its half, its quarter …
  static constexpr std::size_t looks = 8;
  /// Orbits, or blocks of orbits, that an error needs: it is then known to a fifth.
  static constexpr std::uint64_t enough_blocks = 16;

  GrowthSums() = default;
  /// Where there are few orbits, the window is divided into blocks, a power of two, so that at
  /// least 64 numbers tell the error.
  /// `quasi_random`: errors come from replicates of the starts, whatever the number of orbits.
  GrowthSums(TimeWindow, std::uint64_t orbits, bool quasi_random = false);

  const TimeWindow& window() const { return window_; }
  std::size_t blocks() const { return blocks_; }
  double block_length() const { return (window_.to - window_.from) / static_cast<double>(blocks_); }
  /// The last block ends at exactly window().to.
  double block_end(std::size_t block) const;
  double look_time(std::size_t look) const;

  /// `trajectory`: its index, which tells the replicate.
  void add(const OrbitGrowth&, std::uint64_t trajectory = 0);
  void merge(const GrowthSums&);

  /// Sums over blocks of 2^level neighbouring ones, the last level that of whole orbits.
  struct Squares {
    ExactSum growth, product, hits;  ///< squares, and growth times hits
  };
  struct Totals {
    std::uint64_t orbits = 0, chaotic = 0, regular = 0;
    std::array<std::uint64_t, looks> chaotic_at{};  ///< orbits found chaotic at each look
    ExactSum growth, hits;
    ExactSum chaotic_growth, chaotic_squares;  ///< of those that are chaotic
    std::vector<Squares> levels;
    GrowingHistogram distribution;  ///< of the growth over the window
  };
  const Totals& totals() const { return totals_; }
  /// Of quasi-random starts those of each replicate, without levels and distribution; else none.
  const std::vector<Totals>& parts() const { return parts_; }
  /// What was kept. Levels that are missing are empty sums.
  static GrowthSums from(TimeWindow, std::uint64_t blocks, Totals, std::vector<Totals> parts = {});
  static bool may_be_blocks(std::uint64_t blocks);

 private:
  TimeWindow window_;
  std::size_t blocks_ = 1;
  Totals totals_;
  std::vector<Totals> parts_;
};

/// What the sums say. Numbers are NaN where nothing was followed to the window's end.
struct LyapunovEstimate {
  Estimate per_time, per_hit;
  Estimate chaotic;  ///< per time, of the chaotic orbits alone
  /// The error by blocks of growing length: it grows as long as they are shorter than what an orbit
  /// remembers.
  struct BlockError {
    double length;
    std::uint64_t count;
    double error;
  };
  std::vector<BlockError> block_errors;
  bool long_enough = true;  ///< false: the errors of the last lengths still grow
  /// Share of chaotic orbits, those included that stick to islands and have not shown yet, as far
  /// as they can be told: `hidden` of all, from how the numbers found fall from one doubling of the
  /// time to the next.
  Estimate chaotic_share;
  double hidden = 0.0;
  bool settled = true;  ///< false: so many came late that the share may still grow much
};
LyapunovEstimate estimate_of(const GrowthSums&);

/// Points of the finite-time distribution: a share of orbits whose exponent lies in a bin.
struct ExponentBin {
  double from, to;
  std::uint64_t count;
};
std::vector<ExponentBin> distribution_of(const GrowthSums&);

}  // namespace carom
