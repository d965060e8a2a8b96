// Area, length and point location of a region.
#include "carom/geometry/curve_frame.hpp"
#include "carom/geometry/region.hpp"
#include "exact_loop.hpp"

namespace carom::geometry {

int locate(const Loop& loop, Vector point) {
  const ExactLoop exact_loop(loop, DyadicVector{});
  const ExactPoint p{Dyadic(point.x), Dyadic(point.y), Dyadic(1)};
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
