// Follows deviations across the orbits of lanes, if asked to: by kernels where lanes fly, one by
// one where the scalar engine does.
#pragma once

#include <vector>

#include "carom/lanes/lanes.hpp"
#include "carom/table/table.hpp"
#include "lanes/free/filled_pack.hpp"

namespace carom::lanes {

class LaneTangents {
 public:
  /// Refers to both tables.
  LaneTangents(const Table& table, const LaneTable& pieces, TangentKernels kernels)
      : table_(table), pieces_(pieces), kernels_(kernels) {}
  /// Asked to follow from now on.
  void follow(std::vector<double> times, double unit_length, Lanes::Stretched);
  bool any() const { return !times_.empty(); }

  void begin(LaneTrajectory&) const;
  /// Between a trajectory and its lane.
  void put(FilledPack&, int lane) const;
  void take(FilledPack&, int lane) const;
  /// After a sweep: reports marks that were passed, then carries deviations over the hits.
  void sweep(FilledPack&);
  /// The scalar engine has flown it to a hit; its own numbers are still those before.
  void hit(LaneTrajectory&, const State&) const;
  /// It has come to the end.
  void finish(LaneTrajectory& mine) const { tell(mine, Time(times_.back()), true); }

 private:
  double next_mark(const LaneTrajectory&) const;
  /// Of marks before `time`, or also at it.
  void tell(LaneTrajectory&, const Time&, bool also_at) const;

  const Table& table_;
  const LaneTable& pieces_;
  motion::TangentWalls walls_;
  TangentTable forms_;
  TangentKernels kernels_;
  std::vector<double> times_;
  double unit_length_ = 1.0;
  Lanes::Stretched stretched_;
};

}  // namespace carom::lanes
