// Sections: where orbits meet the walls, or a surface in phase space.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "carom/base/fields.hpp"
#include "carom/events/event.hpp"
#include "carom/events/surface.hpp"
#include "carom/geometry/curve_frame.hpp"
#include "carom/table/table.hpp"

namespace carom {

/// Which section is taken ([section] of the system file).
struct SectionPlan {
  bool boundary = true;         ///< at the walls, in Birkhoff coordinates; else at `surface`
  int wall = -1;                ///< boundary: this wall alone; -1: all
  Surface surface;              ///< in the plane: positions on a lattice are unwrapped
  int direction = 0;            ///< +1, -1: crossings of this direction alone; 0: both
  std::uint64_t points = 1000;  ///< most points of a particle; 0: as many as there are until t_max
  std::uint64_t orbits = 0;     ///< trajectories; 0: one a listed start, else at most 50
};

/// One point of a section.
struct SectionPoint {
  std::uint64_t orbit = 0;  ///< index of the trajectory
  std::uint64_t index = 0;  ///< counts the points of a particle's orbit from 0
  std::int32_t particle = 0;
  std::int32_t wall = -1;      ///< boundary: the wall
  std::int32_t direction = 0;  ///< +1 or -1: sense of the crossing; 0 at the boundary
  double t = 0, s = 0, v_parallel = 0;
  double x = 0, y = 0, vx = 0, vy = 0;  ///< unwrapped; after the hit at the boundary
};

template <>
struct Fields<SectionPoint> {
  using P = SectionPoint;
  static constexpr std::tuple list{
      field("orbit", "1", "Index of the trajectory", &P::orbit),
      field("index", "1", "Number of the point in the orbit of its particle, from 0", &P::index),
      field("particle", "1", "Index of the particle", &P::particle),
      field("wall", "1", "Index into the attribute `names`, -1: not at a wall", &P::wall),
      field("direction", "1", "Sense of the crossing, 1 or -1; 0 at a wall", &P::direction),
      field("t", "time", "Time", &P::t),
      field("s", "length",
            "Length along the wall, line or circle; 0 for conditions on the velocity", &P::s),
      field("v_parallel", "length/time",
            "Velocity in the direction of s; 0 for conditions on the velocity", &P::v_parallel),
      field("x", "length", "Position, unwrapped", &P::x),
      field("y", "length", "Position, unwrapped", &P::y),
      field("vx", "length/time", "Velocity, after the hit at a wall", &P::vx),
      field("vy", "length/time", "Velocity, after the hit at a wall", &P::vy)};
};

/// Where the arc lengths of a table's walls begin.
std::vector<geometry::CurveFrame> frames_of(const Table&);

/// Collects the section of one trajectory after another.
class SectionRecorder {
 public:
  /// Refers to all of them.
  SectionRecorder(const Table& table, const SectionPlan& plan,
                  const std::vector<geometry::CurveFrame>& frames)
      : table_(&table), plan_(&plan), frames_(&frames) {}

  /// A start on a wall is a point of the boundary section.
  void begin(std::uint64_t orbit, std::span<const State> starts);
  /// The state after a hit.
  void hit(int particle, const State&);
  /// A crossing of the plan's surface.
  void crossing(int particle, const State&, int direction);
  void end(int particle, Fate);

  /// Has every particle all its points?
  bool done() const;
  const std::vector<SectionPoint>& points() const { return points_; }

 private:
  struct Orbit {
    std::uint64_t count = 0;
    bool moving = true;
  };
  geometry::Vector unwrapped(const State&) const;
  bool full(const Orbit& orbit) const { return plan_->points > 0 && orbit.count >= plan_->points; }

  const Table* table_;
  const SectionPlan* plan_;
  const std::vector<geometry::CurveFrame>* frames_;
  std::uint64_t orbit_ = 0;
  std::vector<Orbit> orbits_;
  std::vector<SectionPoint> points_;
};

}  // namespace carom
