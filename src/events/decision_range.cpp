#include "carom/events/decision_range.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "carom/events/medium.hpp"
#include "carom/geometry/curve_frame.hpp"

namespace carom {

namespace {

using geometry::Vector;

std::string outside(const char* what, const char* where, double value, double low, double high) {
  if (value >= low && value <= high) return "";
  return fmt::format("{}{} is {:.3g}: flights are decided between {:.3g} and {:.3g}", what, where,
                     value, low, high);
}

}  // namespace

DecisionRange::DecisionRange(const Table& table)
    : shortest_(std::numeric_limits<double>::infinity()) {
  for (const Wall& wall : table.walls) {
    const geometry::CurveFrame frame = geometry::frame_of(wall.curve);
    const bool segment = frame.kind == geometry::CurveFrame::Kind::segment;
    shortest_ = std::min(shortest_, segment ? frame.major : std::min(frame.major, frame.minor));
    ellipses_ = ellipses_ || !(segment || frame.circular || frame.bezier);
    const geometry::Box box = geometry::bounding_box(wall.curve);
    reach(box.low);
    reach(box.high);
  }
  if (!table.lattice) return;
  for (const geometry::CellEdge& edge : table.lattice->edges) {
    const Vector d = edge.segment.to - edge.segment.from;
    shortest_ = std::min(shortest_, std::max(std::fabs(d.x), std::fabs(d.y)));
    reach(edge.segment.from);
  }
}

void DecisionRange::reach(Vector x) {
  largest_ = std::max({largest_, std::fabs(x.x), std::fabs(x.y)});
}

std::string DecisionRange::fault(const Particle& p) const {
  const double omega = std::fabs(p.omega), speed = p.speed;
  if (!(speed > 0.0)) return "";  // a disc at rest: it takes part of another's speed
  if (std::string s = outside("the speed", "", speed, 0x1p-200, 0x1p200); !s.empty()) return s;
  if (omega > 0.0)
    if (std::string s = outside("the cyclotron frequency", "", omega, 0x1p-200, 0x1p200);
        !s.empty())
      return s;
  if (!(largest_ > 0.0)) return "";
  // Squares of rates for all walls; an ellipse in a field takes their tenth powers.
  const bool quartics = ellipses_ && omega > 0.0;
  const double most = quartics ? 0x1p60 : 0x1p300;
  const char* const where = quartics ? " beside an ellipse in a magnetic field" : "";
  if (std::string s =
          outside("the speed over the shortest length", where, speed / shortest_, 1.0 / most, most);
      !s.empty())
    return s;
  if (std::string s =
          outside("the speed over the table's size", where, speed / largest_, 1.0 / most, most);
      !s.empty())
    return s;
  return quartics ? outside("the cyclotron frequency", where, omega, 1.0 / most, most) : "";
}

std::string beyond_decisions(const Table& table, std::span<const Particle> particles) {
  const DecisionRange range(table);
  const int regions = static_cast<int>(table.regions.size());
  for (const Particle& p : particles)
    for (int region = -1; region < regions; ++region)
      if (std::string s = range.fault(in_region(table, p, region)); !s.empty()) return s;
  return "";
}

}  // namespace carom
