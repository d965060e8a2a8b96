#include "carom/results/binary_bins.hpp"

#include <numeric>

namespace carom {

namespace {

template <int Digits>
double start_of(std::uint64_t bin) {
  return std::bit_cast<double>(bin << (52 - Digits));
}

}  // namespace

template <int Digits>
void BinaryBins<Digits>::merge(const BinaryBins& other) {
  if (other.counts_.empty()) return;
  reach(other.first_);
  reach(other.first_ + other.counts_.size() - 1);
  for (std::size_t i = 0; i < other.counts_.size(); ++i)
    counts_[other.first_ - first_ + i] += other.counts_[i];
}

template <int Digits>
std::vector<typename BinaryBins<Digits>::Bin> BinaryBins<Digits>::bins() const {
  std::vector<Bin> all;
  for (std::size_t i = 0; i < counts_.size(); ++i)
    all.push_back({start_of<Digits>(first_ + i), start_of<Digits>(first_ + i + 1), counts_[i]});
  return all;
}

template <int Digits>
std::uint64_t BinaryBins<Digits>::total() const {
  return std::accumulate(counts_.begin(), counts_.end(), std::uint64_t{0});
}

template <int Digits>
typename BinaryBins<Digits>::Bin BinaryBins<Digits>::bin_of(double number) {
  const std::uint64_t bin = number_of(number);
  return {start_of<Digits>(bin), start_of<Digits>(bin + 1), 0};
}

template <int Digits>
void BinaryBins<Digits>::reach(std::uint64_t bin) {
  if (counts_.empty()) {
    first_ = bin;
    counts_.resize(1);
  } else if (bin < first_) {
    counts_.insert(counts_.begin(), first_ - bin, 0);
    first_ = bin;
  } else if (bin - first_ >= counts_.size()) {
    counts_.resize(bin - first_ + 1);
  }
}

template class BinaryBins<3>;
template class BinaryBins<6>;

}  // namespace carom
