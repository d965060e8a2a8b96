// The zero between two points of a path on different sides of a surface, to the last digit of its
// time.
#pragma once

#include <cmath>
#include <limits>

namespace carom::events {

/// `path` reports a point its time(), its function g() and the rate() of that, and gives the point
/// at() a time. Of g it is known that low and high are on different sides: g > 0, or not. Newton's
/// steps from the nearer point, halves where they leave the bracket or do not help. It ends at g =
/// 0, or where no double is left between the two sides; of these the one with the smaller |g|.
template <class Path, class Point>
Point bracketed_root(Path& path, Point low, Point high) {
  const bool rising = path.g(high) > 0.0;
  const auto nearer = [&] { return std::fabs(path.g(low)) < std::fabs(path.g(high)) ? low : high; };
  Point best = nearer();
  bool helps = true;
  double least = 0.0;  // a step that Newton's would not make, so that the far side closes up, too
  while (path.g(best) != 0.0) {
    const double from = path.time(low), to = path.time(high), now = path.time(best),
                 g = path.g(best);
    double time = now - g / path.rate(best);
    const double digit = std::numeric_limits<double>::epsilon() * std::fabs(now);
    if (std::fabs(time - now) <= digit) {
      least = least > 0.0 ? 2.0 * least : digit;
      time = now + ((g > 0.0) == rising ? -least : least);
    }
    if (!helps || !(time > from && time < to)) time = from + 0.5 * (to - from);
    if (!(time > from && time < to)) break;
    const Point next = path.at(time);
    ((path.g(next) > 0.0) == rising ? high : low) = next;
    // By rounding a step within the last digits need not help.
    helps = least > 0.0 || std::fabs(path.g(next)) <= 0.5 * std::fabs(g);
    best = nearer();
  }
  return best;
}

}  // namespace carom::events
