// The hits and samples of a run as tables hold them: archives, Python, pictures.
#pragma once

#include <cstdint>
#include <vector>

#include "carom/events/event.hpp"
#include "carom/geometry/curve_frame.hpp"
#include "carom/table/table.hpp"

namespace carom {

/// A reflection; velocities are those after it.
struct HitRow {
  std::int32_t particle = 0, wall = 0;
  double u = 0;           ///< parameter on the wall
  double s = 0;           ///< arc length along the wall
  double v_parallel = 0;  ///< velocity along it, in the direction of s
  double t = 0;
  double x = 0, y = 0, vx = 0, vy = 0;  ///< in the plane, unwrapped
  std::int64_t cell_first = 0, cell_second = 0;
  std::int32_t reflections = 1;  ///< n at a corner of angle pi/n, else 1
};

/// A particle at a time.
struct SampleRow {
  std::int32_t particle = 0;
  double t = 0;
  double x = 0, y = 0, vx = 0, vy = 0;  ///< in the plane, unwrapped
  std::int64_t cell_first = 0, cell_second = 0;
};

/// `frames`: those of frames_of(table) (analysis/section.hpp).
HitRow hit_row(const HitEvent&, const Table&, const std::vector<geometry::CurveFrame>& frames);
SampleRow sample_row(int particle, Time, const State&, const Table&);

}  // namespace carom
