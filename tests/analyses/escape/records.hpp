// The records of an ensemble's trajectories, as its journal gets them.
#pragma once

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

#include "carom/analyses/escape.hpp"

namespace carom {

/// Calls a function with the records of each block, which come in any order.
struct EscapeRecords : EscapeJournal {
  explicit EscapeRecords(std::function<void(const std::vector<TrajectoryRecord>&)> function)
      : take(std::move(function)) {}
  bool wants_records() const override { return true; }
  void block(TrajectoryRange, std::vector<TrajectoryRecord>&& records) override { take(records); }
  void save(const EscapeResult&) override {}
  std::function<void(const std::vector<TrajectoryRecord>&)> take;
};

/// The result, and in `records` those of all blocks by index.
inline EscapeResult run_escape(const System& system, EscapeOptions options,
                               std::vector<TrajectoryRecord>& records) {
  EscapeRecords journal([&](const std::vector<TrajectoryRecord>& more) {
    records.insert(records.end(), more.begin(), more.end());
  });
  options.journal = &journal;
  EscapeResult result = run_escape(system, options);
  std::sort(records.begin(), records.end(),
            [](const TrajectoryRecord& a, const TrajectoryRecord& b) { return a.index < b.index; });
  return result;
}

}  // namespace carom
