#include "carom/analysis/escape_times.hpp"

#include <bit>
#include <numeric>

namespace carom {

namespace {

// 52 binary digits follow the first of a double; six are kept.
constexpr int dropped_digits = 52 - 6;

std::uint64_t number_of(double time) {
  return std::bit_cast<std::uint64_t>(time) >> dropped_digits;
}
double start_of(std::uint64_t bin) { return std::bit_cast<double>(bin << dropped_digits); }

}  // namespace

void EscapeTimes::add(double time, std::uint64_t count) {
  if (!(time > 0.0)) return;
  const std::uint64_t bin = number_of(time);
  reach(bin);
  counts_[bin - first_] += count;
}

void EscapeTimes::merge(const EscapeTimes& other) {
  if (other.counts_.empty()) return;
  reach(other.first_);
  reach(other.first_ + other.counts_.size() - 1);
  for (std::size_t i = 0; i < other.counts_.size(); ++i)
    counts_[other.first_ - first_ + i] += other.counts_[i];
}

std::vector<EscapeTimes::Bin> EscapeTimes::bins() const {
  std::vector<Bin> all;
  for (std::size_t i = 0; i < counts_.size(); ++i)
    all.push_back({start_of(first_ + i), start_of(first_ + i + 1), counts_[i]});
  return all;
}

std::uint64_t EscapeTimes::total() const {
  return std::accumulate(counts_.begin(), counts_.end(), std::uint64_t{0});
}

EscapeTimes::Bin EscapeTimes::bin_of(double time) {
  const std::uint64_t bin = number_of(time);
  return {start_of(bin), start_of(bin + 1), 0};
}

void EscapeTimes::reach(std::uint64_t bin) {
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

}  // namespace carom
