// What the growth of deviations says of orbits: Lyapunov exponents with their errors, their
// distribution, and which orbits are chaotic. docs/physics/lyapunov.md derives the estimators.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "carom/base/exact_sum.hpp"
#include "carom/base/fields.hpp"
#include "carom/results/estimate.hpp"
#include "carom/results/interval.hpp"

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

/// How two deviations have grown, by how far they have turned into one direction (SALI, in two
/// dimensions GALI_2): their area is kept, so its logarithm is minus that of the product of their
/// lengths. `linear`: no more than on an invariant curve. Such an orbit is regular, or it is
/// chaotic and has not shown it: only the whole ensemble tells which
/// (LyapunovEstimate::tells_regular).
enum class Regularity : unsigned char { linear, chaotic, undecided };
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
  double flights = 0.0;  ///< mean flights, or other natural times, until the window's end
};

/// Sums over orbits that were followed to the end of the window.
class GrowthSums {
 public:
  /// Times at which orbits are looked at for chaos: the end of the window, its half, its quarter …
  static constexpr std::size_t looks = 8;
  /// Orbits, or blocks of orbits, that an error needs: it is then known to a fifth.
  static constexpr std::uint64_t enough_blocks = 16;
  /// Fewer orbits than these have blocks, so that this many numbers at least tell how the error
  /// grows with the length of blocks.
  static constexpr std::uint64_t few_orbits = 64, wanted_blocks = 1024;

  GrowthSums() = default;
  /// Where there are few orbits, the window is divided into blocks, a power of two.
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
    std::uint64_t orbits = 0, chaotic = 0, linear = 0;
    std::array<std::uint64_t, looks> chaotic_at{};  ///< orbits found chaotic at each look
    ExactSum growth, hits;
    ExactSum chaotic_growth, chaotic_squares;  ///< of those that are chaotic
    ExactSum flights;                          ///< until the window's end; not of replicates
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
  /// How the deviations of the ensemble grow. `linear`: those of no orbit grow faster than on
  /// regular orbits, and the exponent is 0. `unknown`: the run is too short to tell linear growth
  /// from an exponential one, and there is no exponent.
  enum class Law { exponential, linear, unknown };
  Law law = Law::exponential;
  /// Where the law is linear by the data: a larger exponent would have shown. 0: the law is known.
  double would_show = 0.0;
  Estimate per_time, per_hit;  ///< regular orbits have the exponent 0
  /// The error by blocks of growing length: it grows as long as they are shorter than what an orbit
  /// remembers.
  struct BlockError {
    double length;
    std::uint64_t count;
    double error;
  };
  std::vector<BlockError> block_errors;
  /// False: the errors grow with the length of the blocks, or deviations grow little in the
  /// shortest.
  bool long_enough = true;
  /// Time after which an orbit of the chaotic sea is found chaotic; NaN where none was.
  double waiting_time = 0.0;
  bool tells_regular = false;  ///< may orbits whose growth is linear be called regular?
  /// Share of chaotic orbits, those included that stick to islands and have not shown yet: `hidden`
  /// of all, from those that were found late. Its error is the larger side of the interval of 95 %
  /// over 1.96. NaN where the run is too short, or no orbit is chaotic and the law is not known.
  Estimate chaotic_share;
  Interval share_interval;
  double hidden = 0.0, hidden_error = 0.0;
  Estimate chaotic;  ///< per time, of the chaotic orbits alone; NaN without a share
  /// By how much the exponent is too large if the orbits that have not shown chaos are regular.
  double regular_bias = 0.0;
};
/// `regular`: do conservation laws or the walls make all deviations grow linearly
/// (why_all_are_regular)?
LyapunovEstimate estimate_of(const GrowthSums&, bool regular = false);
/// Of these the means over all orbits with their errors, whatever the law of growth.
LyapunovEstimate mean_growth_of(const GrowthSums&);

/// Points of the finite-time distribution: a share of orbits whose exponent lies in a bin.
struct ExponentBin {
  double from, to;
  std::uint64_t count;
};
template <>
struct Fields<ExponentBin> {
  using B = ExponentBin;
  static constexpr std::tuple list{
      field("bin_from", "1/time", "Finite-time exponents: start of the bin", &B::from),
      field("bin_to", "1/time", "Its end", &B::to),
      field("bin_count", "1", "Orbits with an exponent in it", &B::count)};
};
std::vector<ExponentBin> distribution_of(const GrowthSums&);
/// Below which a share `q` of the orbits lies, exponents spread evenly within each bin; NaN without
/// orbits.
double quantile_of(const std::vector<ExponentBin>&, double q);

}  // namespace carom
