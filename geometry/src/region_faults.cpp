#include "region_faults.hpp"

#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "carom/geometry/curve_frame.hpp"

namespace carom::geometry {

namespace {

using Kind = RegionFault::Kind;

struct Finite {
  static bool all(auto... v) { return (std::isfinite(v) && ...); }
  bool operator()(const Segment& s) const { return all(s.from.x, s.from.y, s.to.x, s.to.y); }
  bool operator()(const CircularArc& a) const {
    return all(a.from.x, a.from.y, a.to.x, a.to.y, a.offset);
  }
  bool operator()(const Circle& c) const { return all(c.centre.x, c.centre.y, c.radius); }
  bool operator()(const EllipticArc& a) const {
    return all(a.from.x, a.from.y, a.to.x, a.to.y, a.axis.x, a.axis.y, a.ratio, a.offset);
  }
  bool operator()(const Ellipse& e) const {
    return all(e.centre.x, e.centre.y, e.axis.x, e.axis.y, e.ratio);
  }
  bool operator()(const Bezier& b) const {
    for (int i = 0; i <= b.degree; ++i)
      if (!all(b.control(i).x, b.control(i).y)) return false;
    return true;
  }
};

}  // namespace

std::string place_text(Vector place, int digits) {
  char buffer[80];
  std::snprintf(buffer, sizeof buffer, "(%.*g, %.*g)", digits, place.x, digits, place.y);
  return buffer;
}

void check_extent(const Loop& loop, RegionFaults& faults) {
  for (const NamedCurve& c : loop) {
    if (!std::visit(Finite{}, c.curve)) {
      faults.add(Kind::no_extent, c.name, "", {},
                 "wall '" + c.name + "' has a number that is not finite");
      continue;
    }
    try {
      frame_of(c.curve);
    } catch (const std::invalid_argument& e) {
      faults.add(Kind::no_extent, c.name, "", start_point(c.curve),
                 "wall '" + c.name + "': " + e.what());
    }
  }
}

void check_closed(const Loop& loop, RegionFaults& faults) {
  if (loop.empty()) faults.add(Kind::open_loop, "", "", {}, "a loop without walls");
  if (loop.size() == 1 && is_closed(loop[0].curve)) return;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const NamedCurve &c = loop[i], &next = loop[i + 1 == loop.size() ? 0 : i + 1];
    const Vector end = end_point(c.curve), start = start_point(next.curve);
    if (is_closed(c.curve)) {
      faults.add(Kind::open_loop, c.name, "", end,
                 "wall '" + c.name + "' is closed by itself and cannot be a part of a loop");
    } else if (!is_closed(next.curve) && end != start) {
      // With as many digits as it takes to see the difference.
      const int digits = place_text(end) != place_text(start) ? 4 : 17;
      faults.add(Kind::open_loop, c.name, next.name, end,
                 "the loop is open: wall '" + c.name + "' ends at " + place_text(end, digits) +
                     ", but '" + next.name + "' starts at " + place_text(start, digits));
    }
  }
}

}  // namespace carom::geometry
