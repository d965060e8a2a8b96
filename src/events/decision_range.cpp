#include "carom/events/decision_range.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "carom/geometry/curve_frame.hpp"

namespace carom {

namespace {

using geometry::Vector;

std::string shown(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", x);
  return text;
}

/// The shortest wall, radius or semi-axis, and the largest coordinate.
struct Lengths {
  double shortest = std::numeric_limits<double>::infinity(), largest = 0.0;
  bool ellipses = false;

  explicit Lengths(const Table& table) {
    for (const Wall& wall : table.walls) {
      const geometry::CurveFrame frame = geometry::frame_of(wall.curve);
      const bool segment = frame.kind == geometry::CurveFrame::Kind::segment;
      shortest = std::min(shortest, segment ? frame.major : std::min(frame.major, frame.minor));
      ellipses = ellipses || !(segment || frame.circular);
      const geometry::Box box = geometry::bounding_box(wall.curve);
      reach(box.low);
      reach(box.high);
    }
    if (!table.lattice) return;
    for (const geometry::CellEdge& edge : table.lattice->edges) {
      const Vector d = edge.segment.to - edge.segment.from;
      shortest = std::min(shortest, std::max(std::fabs(d.x), std::fabs(d.y)));
      reach(edge.segment.from);
    }
  }
  void reach(Vector x) { largest = std::max({largest, std::fabs(x.x), std::fabs(x.y)}); }
};

std::string fault(const std::string& what, double value, double low, double high) {
  if (value >= low && value <= high) return "";
  return what + " is " + shown(value) + ": flights are decided between " + shown(low) + " and " + shown(high);
}

std::string fault_of(const Lengths& lengths, const Particle& p) {
  const double omega = std::fabs(p.omega), speed = p.speed;
  if (!(speed > 0.0)) return "";  // a disc at rest: it takes part of another's speed
  if (std::string s = fault("the speed", speed, 0x1p-200, 0x1p200); !s.empty()) return s;
  if (omega > 0.0)
    if (std::string s = fault("the cyclotron frequency", omega, 0x1p-200, 0x1p200); !s.empty()) return s;
  if (!(lengths.largest > 0.0)) return "";
  // Squares of rates for all walls; an ellipse in a field takes their tenth powers.
  const bool quartics = lengths.ellipses && omega > 0.0;
  const double most = quartics ? 0x1p60 : 0x1p300;
  const std::string where = quartics ? " beside an ellipse in a magnetic field" : "";
  if (std::string s = fault("the speed over the shortest length" + where, speed / lengths.shortest, 1.0 / most, most);
      !s.empty())
    return s;
  if (std::string s = fault("the speed over the table's size" + where, speed / lengths.largest, 1.0 / most, most);
      !s.empty())
    return s;
  return quartics ? fault("the cyclotron frequency" + where, omega, 1.0 / most, most) : "";
}

}  // namespace

std::string beyond_decisions(const Table& table, std::span<const Particle> particles) {
  const Lengths lengths(table);
  for (const Particle& p : particles)
    if (std::string s = fault_of(lengths, p); !s.empty()) return s;
  return "";
}

}  // namespace carom
