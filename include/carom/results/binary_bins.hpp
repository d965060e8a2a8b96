// Counts of positive numbers in fixed bins, so that counts of any parts add up.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

namespace carom {

/// A bin holds the positive doubles that share their exponent and the first binary digits after it,
/// so there are 2^Digits bins to a factor of two. They do not depend on what is counted: counts of
/// any parts add up, in any order.
template <int Digits>
class BinaryBins {
 public:
  /// Numbers in [from, to).
  struct Bin {
    double from, to;
    std::uint64_t count;
    bool operator==(const Bin&) const = default;
  };

  /// A finite number; one that is not positive is in no bin.
  void add(double number) { add(number, 1); }
  void add(double number, std::uint64_t count) {
    if (!(number > 0.0)) return;
    const std::uint64_t bin = number_of(number);
    if (bin - first_ >= counts_.size()) reach(bin);  // one before the first is beyond all, too
    counts_[bin - first_] += count;
  }
  void merge(const BinaryBins& other);

  /// From the first bin with a count to the last; those between may be empty.
  std::vector<Bin> bins() const;
  std::uint64_t total() const;

  /// The bin of a positive number, without its count.
  static Bin bin_of(double number);
  /// Bins of positive numbers are numbered in order: 52 binary digits follow the first of a double.
  static std::uint64_t number_of(double number) {
    return std::bit_cast<std::uint64_t>(number) >> (52 - Digits);
  }

 private:
  void reach(std::uint64_t bin);
  std::uint64_t first_ = 0;  ///< number of the bin of counts_[0]
  std::vector<std::uint64_t> counts_;
};

extern template class BinaryBins<3>;
extern template class BinaryBins<6>;

}  // namespace carom
