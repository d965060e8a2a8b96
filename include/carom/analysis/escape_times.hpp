// Times of escape in fine bins.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace carom {

/// Numbers of escapes in bins of time, 64 bins to a factor of two: a bin holds the positive doubles
/// that share their exponent and the first six binary digits after it. Bins are the same for every
/// ensemble, so that counts of any parts add up, in any order.
class EscapeTimes {
 public:
  /// Times in [from, to).
  struct Bin {
    double from, to;
    std::uint64_t count;
    bool operator==(const Bin&) const = default;
  };

  /// A finite time; one that is not positive is in no bin.
  void add(double time) { add(time, 1); }
  void add(double time, std::uint64_t count);
  void merge(const EscapeTimes& other);

  /// From the first bin with a count to the last; those between may be empty.
  std::vector<Bin> bins() const;
  std::uint64_t total() const;

  /// The bin of a positive time, without its count.
  static Bin bin_of(double time);

 private:
  void reach(std::uint64_t bin);
  std::uint64_t first_ = 0;  ///< number of the bin of counts_[0]
  std::vector<std::uint64_t> counts_;
};

}  // namespace carom
