// A pack and the trajectories that fly in its lanes.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "carom/lanes/lanes.hpp"
#include "lanes/free/lane_pack.hpp"
#include "lanes/free/tangent_pack.hpp"
#include "motion/free_tangent.hpp"

namespace carom::lanes {

/// What a lane's trajectory needs besides its numbers in the pack.
struct LaneTrajectory {
  LaneStart start;               ///< or where the scalar engine left it
  std::uint64_t first_hits = 0;  ///< when it began
  std::size_t reported = 0;      ///< times
  std::uint64_t heard = 0;       ///< hits that were reported, if they are
  motion::FreeTangent tangent;   ///< where `start` is, if deviations are followed
  std::size_t marked = 0;        ///< times at which their lengths were reported

  int last_wall() const { return start.hits > first_hits ? start.state.wall : -1; }
};

struct FilledPack {
  LanePack pack;
  TangentPack tangents;  ///< if deviations are followed
  LaneTrajectory trajectories[LanePack::lanes];
  /// Trajectories go from one pack or lane to another by swapping these: they are long.
  LaneTrajectory* of_lane[LanePack::lanes];
  int busy = 0;

  FilledPack() {
    for (int lane = 0; lane < LanePack::lanes; ++lane) of_lane[lane] = &trajectories[lane];
  }
  FilledPack(const FilledPack&) = delete;
  FilledPack& operator=(const FilledPack&) = delete;

  LaneTrajectory& trajectory(int lane) { return *of_lane[lane]; }
  const LaneTrajectory& trajectory(int lane) const { return *of_lane[lane]; }

  void clear() {
    busy = 0;
    for (double& active : pack.active) active = 0.0;
  }
  void leave(int lane) {
    if (pack.active[lane] != 0.0) --busy;
    pack.active[lane] = 0.0;
  }
  /// To the cells of their homes: those of hits are counted in 32 bits.
  void add_cells() {
    for (int lane = 0; lane < LanePack::lanes; ++lane) {
      pack.home_first[lane] += std::exchange(pack.cells[2 * lane], 0);
      pack.home_second[lane] += std::exchange(pack.cells[2 * lane + 1], 0);
    }
  }
  /// A lane's last event, except for its wall, which is left as it is.
  void last_event(int lane, State& s) const {
    s.position.x = pack.x[lane];
    s.position.y = pack.y[lane];
    s.velocity.x = pack.vx[lane];
    s.velocity.y = pack.vy[lane];
    s.time.high = pack.high[lane];
    s.time.low = pack.low[lane];
    s.cell.first = static_cast<std::int64_t>(pack.home_first[lane]) + pack.cells[2 * lane];
    s.cell.second = static_cast<std::int64_t>(pack.home_second[lane]) + pack.cells[2 * lane + 1];
  }
  /// Calls for lanes that have made all their hits.
  void cap() {
    if (pack.sweep < pack.next_cap) return;
    pack.next_cap = HUGE_VAL;
    for (int lane = 0; lane < pack.used; ++lane) {
      if (pack.active[lane] == 0.0) continue;
      const auto before = static_cast<double>(trajectory(lane).start.hits);
      if (pack.hits(lane) < pack.limit || pack.hits(lane) == before) {
        pack.next_cap = std::min(pack.next_cap, pack.born[lane] + pack.limit);
        continue;
      }
      pack.lane[pack.calls] = lane;
      pack.call[pack.calls++] = Call::capped;
    }
  }
};

}  // namespace carom::lanes
