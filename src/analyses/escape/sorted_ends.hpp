// Which of given numbers is the first that is not below another.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "carom/analyses/escape/survival.hpp"

namespace carom::analyses {

/// Increasing numbers: ends of bins that hold their end, not their start. A search by halves is a
/// chain of loads and comparisons. The fine bin of a number (EscapeTimes) tells the answer at once
/// where no end lies in it, and leaves few ends to search elsewhere.
class SortedEnds {
 public:
  explicit SortedEnds(std::vector<double> ends) : ends_(std::move(ends)) {
    auto next = std::upper_bound(ends_.begin(), ends_.end(), 0.0);
    const auto below = [&] { return static_cast<std::size_t>(next - ends_.begin()); };
    before_ = {below()};
    if (next != ends_.end()) first_ = EscapeTimes::number_of(*next);
    for (std::uint64_t bin = first_; next != ends_.end(); ++bin) {
      before_.push_back(below());
      while (next != ends_.end() && EscapeTimes::number_of(*next) == bin) ++next;
    }
    before_.insert(before_.end(), 2, below());
  }

  /// The index of the first end at or after a number; their count if there is none.
  std::size_t first_from(double number) const {
    std::size_t from = 0, to = ends_.size();
    if (number > 0.0) {
      const std::uint64_t bin = EscapeTimes::number_of(number);
      const std::size_t i =
          bin < first_ ? 0 : std::min<std::size_t>(bin - first_ + 1, before_.size() - 2);
      from = before_[i];
      to = before_[i + 1];
    }
    // The halves are chosen without a branch, which would be foretold wrongly every other time.
    const double* first = ends_.data() + from;
    for (std::size_t left = to - from; left > 0;) {
      const std::size_t half = (left + 1) / 2;
      first += half & (std::size_t{0} - static_cast<std::size_t>(first[half - 1] < number));
      left -= half;
    }
    return static_cast<std::size_t>(first - ends_.data());
  }

 private:
  std::vector<double> ends_;
  std::uint64_t first_ = UINT64_MAX;  ///< bin of the first positive end
  /// How many ends lie before a bin, for all bins before first_ together, then from it on.
  std::vector<std::size_t> before_;
};

}  // namespace carom::analyses
