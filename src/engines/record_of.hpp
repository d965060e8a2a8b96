// The record of a particle: its start and its end.
#pragma once

#include <cstdint>
#include <vector>

#include "carom/engines/engine.hpp"
#include "carom/geometry/curve_frame.hpp"
#include "carom/results/ensemble_result.hpp"
#include "carom/system/system.hpp"
#include "carom/table/hole_names.hpp"

namespace carom::engines {

class RecordMaker {
 public:
  explicit RecordMaker(const System& system)
      : table_(*system.table), holes_(hole_numbers(*system.table)) {
    for (const Wall& wall : table_.walls) frames_.push_back(geometry::frame_of(wall.curve));
  }
  /// Index into hole_names(), or -1.
  int hole_of(const ParticleEnd& end) const {
    return end.hole < 0 ? -1 : holes_[static_cast<std::size_t>(end.hole)];
  }
  TrajectoryRecord operator()(std::uint64_t index, const State& start,
                              const ParticleEnd& end) const {
    TrajectoryRecord r;
    geometry::Vector position = start.position;
    if (table_.lattice) position = position + table_.lattice->translation(start.cell);
    r.index = index;
    r.x = position.x, r.y = position.y;
    r.vx = start.velocity.x, r.vy = start.velocity.y;
    r.fate = end.fate;
    r.hole = hole_of(end);
    r.time = end.time;
    r.hits = end.hits;
    r.wall = start.wall;
    if (start.wall >= 0) {
      const geometry::CurveFrame& frame = frames_[static_cast<std::size_t>(start.wall)];
      r.s = geometry::arc_length_at(frame, start.u);
      r.v_parallel = dot(geometry::tangent_at(frame, start.u), start.velocity);
    }
    return r;
  }

 private:
  const Table& table_;
  std::vector<int> holes_;
  std::vector<geometry::CurveFrame> frames_;  // one a wall
};

}  // namespace carom::engines
