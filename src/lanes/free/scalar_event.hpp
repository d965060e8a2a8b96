// The scalar engine does one event of a lane's trajectory.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "carom/events/world.hpp"
#include "carom/lanes/lanes.hpp"
#include "events/flight/piece_table.hpp"
#include "lanes/free/lane_start.hpp"
#include "lanes/free/lane_table.hpp"

namespace carom::lanes {

/// Flies what lanes cannot decide, and notes in the lanes' table where such flights leave.
class ScalarEvent {
 public:
  /// `pieces`: of the world's table.
  ScalarEvent(World world, LaneTable& pieces, Turn turn);

  /// From the start to its next event, or to `t_end`. `times`: those to sample at; `limit`: most
  /// hits.
  void fly(const LaneStart& start, std::vector<double> times, std::uint64_t limit, double t_end,
           const std::function<bool()>& stopped);
  /// All flights that the joints' sides tell to be like the one that was flown leave where it did.
  void learn();

  const events::PieceTable& walls() const { return world_.pieces(); }
  DecisionCounts decisions() const { return world_.decisions(); }

  // Of the particle that was flown:
  State state() const { return world_.state(0); }
  std::uint64_t hits() const { return world_.hits(0); }
  Fate fate() const { return world_.fate(0); }
  int hole() const { return world_.hole(0); }
  const std::string& report() const { return world_.report(0); }
  /// When it ended, or its last event.
  Time time() const { return world_.finished(0) ? seen_.time : world_.state(0).time; }
  /// Its states at the times that were passed.
  const std::vector<State>& samples() const { return seen_.states; }

 private:
  struct Seen : Observer {
    void end(const EndEvent& event) override { time = event.time; }
    void sample(int, Time, const State& state) override { states.push_back(state); }
    Time time;
    std::vector<State> states;
  };
  int entry_at(const LaneStart& start) const;

  World world_;
  LaneTable& pieces_;
  const Turn turn_;
  Seen seen_;
  int entry_ = -1;  ///< of the flight
  std::uint64_t hits_before_ = 0;
};

}  // namespace carom::lanes
