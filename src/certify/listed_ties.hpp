// Ties that algebra has found at an event, listed once the orbit has gone through them: it may end before.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "certify/attempt.hpp"

namespace carom::certify {

class ListedTies {
 public:
  void found(std::uint64_t event, const Tie& tie) {
    ++count_;
    waiting_.push_back({event, tie.text, tie.kind == Tie::tangency ? tie.walls.front() : Copy{}});
  }
  /// How many were found.
  std::size_t count() const { return count_; }
  /// The attempt's last step came to that event.
  void pass(std::uint64_t event, const Attempt& attempt, std::vector<std::string>& list) {
    take(event, attempt, list, [](const Waiting&) { return true; });
  }
  /// It ended at the last time, before that event: walls may have been touched.
  void pass_touched(std::uint64_t event, const Attempt& attempt, std::vector<std::string>& list) {
    take(event, attempt, list, [](const Waiting& tie) { return tie.touched.wall >= 0; });
  }

 private:
  struct Waiting {
    std::uint64_t event;
    std::string text;
    Copy touched;  ///< of a tangency
  };
  template <class Which>
  void take(std::uint64_t event, const Attempt& attempt, std::vector<std::string>& list, Which which) {
    for (const Waiting& tie : waiting_) {
      if (tie.event > event || !which(tie)) continue;
      if (tie.touched.wall < 0 || !attempt.lies_behind(tie.touched)) list.push_back(tie.text);
    }
    std::erase_if(waiting_, [&](const Waiting& tie) { return tie.event <= event; });
  }
  std::vector<Waiting> waiting_;
  std::size_t count_ = 0;
};

}  // namespace carom::certify
