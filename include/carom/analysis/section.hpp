// Sections: where orbits meet the walls, or a surface in phase space.
#pragma once

#include <cstdint>
#include <vector>

#include "carom/events/observer.hpp"
#include "carom/events/surface.hpp"
#include "carom/geometry/curve_frame.hpp"
#include "carom/table/table.hpp"

namespace carom {

class World;

/// Which section is taken ([section] of the system file).
struct SectionPlan {
  bool boundary = true;       ///< at the walls, in Birkhoff coordinates; else at `surface`
  int wall = -1;              ///< boundary: this wall alone; -1: all
  Surface surface;            ///< in the plane: positions on a lattice are unwrapped
  int direction = 0;          ///< +1, -1: crossings of this direction alone; 0: both
  std::uint64_t points = 1000;  ///< most points of a particle; 0: as many as there are until t_max
  std::uint64_t orbits = 0;   ///< trajectories; 0: one a listed start, else at most 50
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

/// Collects the section of one trajectory after another, from a world that watches the plan's surface.
class SectionRecorder : public Observer {
 public:
  SectionRecorder(const Table&, const SectionPlan&);

  /// The particles of the world are about to move. A start on a wall is a point of the boundary section.
  void begin(std::uint64_t orbit, const World&);
  void hit(const HitEvent&) override;
  void end(const EndEvent&) override;
  void crossing(int particle, Time, const State&, int direction) override;

  /// Has every particle all its points?
  bool done() const;
  const std::vector<SectionPoint>& points() const { return points_; }

 private:
  struct Orbit {
    std::uint64_t count = 0;
    bool moving = true;
  };
  geometry::Vector unwrapped(geometry::Vector position, const geometry::Cell& cell) const;
  bool full(const Orbit& orbit) const { return plan_.points > 0 && orbit.count >= plan_.points; }
  void add_hit(int particle, int wall, double u, Time, geometry::Vector position, geometry::Vector velocity);

  const Table& table_;
  const SectionPlan& plan_;
  std::vector<geometry::CurveFrame> frames_;
  std::uint64_t orbit_ = 0;
  std::vector<Orbit> orbits_;
  std::vector<SectionPoint> points_;
};

}  // namespace carom
