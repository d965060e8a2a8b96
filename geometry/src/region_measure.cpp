// Area, length and point location of a region.
#include "carom/geometry/curve_frame.hpp"
#include "carom/geometry/region.hpp"
#include "exact_loop.hpp"

namespace carom::geometry {

namespace {
ExactPoint exactly(Vector point) { return {Dyadic(point.x), Dyadic(point.y), Dyadic(1)}; }
}  // namespace

bool passes_through(const Curve& curve, Vector point) {
  return ExactLoop({{"", curve}}, DyadicVector{}).on_boundary(exactly(point));
}

int locate(const Loop& loop, Vector point) {
  const ExactLoop exact_loop(loop, DyadicVector{});
  const ExactPoint p = exactly(point);
  if (exact_loop.on_boundary(p)) return 0;
  return exact_loop.inside(p) == exact_loop.counterclockwise() ? 1 : -1;
}

double area(const std::vector<Loop>& loops) {
  double sum = 0.0;
  for (const Loop& loop : loops) {
    if (loop.empty()) continue;
    // Chords seen from the loop's own start: a small loop far from the origin keeps its digits.
    const Vector origin = start_point(loop.front().curve);
    double own = 0.0;
    for (const NamedCurve& c : loop) {
      own += 0.5 * cross(start_point(c.curve) - origin, end_point(c.curve) - origin);
      own += area_beyond_chord(frame_of(c.curve));
    }
    sum += own;
  }
  return sum;
}

double perimeter(const std::vector<Loop>& loops) {
  double sum = 0.0;
  for (const Loop& loop : loops)
    for (const NamedCurve& c : loop) sum += length(c.curve);
  return sum;
}

}  // namespace carom::geometry
