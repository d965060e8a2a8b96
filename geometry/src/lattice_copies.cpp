#include "carom/geometry/lattice_copies.hpp"

#include <algorithm>
#include <cmath>

#include "exact_curve.hpp"
#include "exact_loop.hpp"

namespace carom::geometry {

namespace {

/// Whole numbers from low to high.
struct Range {
  double low, high;
};

Range within(Range a, const Range& b) {
  return {std::fmax(a.low, b.low), std::fmin(a.high, b.high)};
}
Range rounded_out(const Range& r) { return {std::floor(r.low) - 1.0, std::ceil(r.high) + 1.0}; }

/// The i for which start + i step lies within the bounds.
Range steps(const Range& bounds, double start, double step) {
  if (step == 0.0) return {-HUGE_VAL, HUGE_VAL};
  const double a = (bounds.low - start) / step, b = (bounds.high - start) / step;
  return {std::fmin(a, b), std::fmax(a, b)};
}

}  // namespace

Vector displacement(const Lattice& lattice, const Cell& c) {
  const DyadicVector t = Dyadic(static_cast<double>(c.first)) * exact(lattice.first) +
                         Dyadic(static_cast<double>(c.second)) * exact(lattice.second);
  return {t.x.approximate(), t.y.approximate()};
}

/// The cell's neighbours lie at the shortest vectors.
ShortestCells shortest_cells(const Lattice& lattice) {
  std::vector<Cell> beyond;
  for (const CellEdge& e : lattice.edges) beyond.push_back(e.beyond);
  const auto square = [&](const Cell& c) {
    return dot(displacement(lattice, c), displacement(lattice, c));
  };
  std::stable_sort(beyond.begin(), beyond.end(),
                   [&](const Cell& a, const Cell& b) { return square(a) < square(b); });
  const Cell a = beyond.front();
  for (const Cell& b : beyond)
    if (!(b == a) && !(b == Cell{-a.first, -a.second})) return {a, b};
  return {a, a};  // not with a cell that has an inside
}

std::optional<std::vector<Cell>> cells_that_reach(const Lattice& lattice, const Box& moving,
                                                  const Box& fixed, std::size_t most) {
  // Within these bounds lies the displacement t. Their rounding, and that of i a + j b below, is
  // far less than u times 16 times the largest number about.
  Box bounds{fixed.low - moving.high, fixed.high - moving.low};
  double largest = 0.0;
  for (const Vector& v : {fixed.low, fixed.high, moving.low, moving.high})
    largest = std::fmax(largest, std::fmax(std::fabs(v.x), std::fabs(v.y)));
  const auto [cell_a, cell_b] = shortest_cells(lattice);
  const Vector a = displacement(lattice, cell_a), b = displacement(lattice, cell_b);
  const double slack = 0x1p-48 * (largest + std::sqrt(dot(a, a)) + std::sqrt(dot(b, b)));
  bounds.low = bounds.low - Vector{slack, slack};
  bounds.high = bounds.high + Vector{slack, slack};

  // cross(a, t) = j cross(a, b): shortest vectors are never close to parallel.
  const double area = cross(a, b);
  Range rows{HUGE_VAL, -HUGE_VAL};
  for (const Vector& t : {bounds.low, bounds.high, Vector{bounds.low.x, bounds.high.y},
                          Vector{bounds.high.x, bounds.low.y}}) {
    const double j = cross(a, t) / area;
    rows = {std::fmin(rows.low, j), std::fmax(rows.high, j)};
  }
  rows = rounded_out(rows);
  const double enough = static_cast<double>(most);
  if (!(rows.high - rows.low <= enough + 8.0)) return std::nullopt;
  std::vector<Cell> found;
  for (double j = rows.low; j <= rows.high; j += 1.0) {
    const Range columns = rounded_out(within(steps({bounds.low.x, bounds.high.x}, j * b.x, a.x),
                                             steps({bounds.low.y, bounds.high.y}, j * b.y, a.y)));
    if (columns.high - columns.low > enough + 8.0) return std::nullopt;
    for (double i = columns.low; i <= columns.high; i += 1.0) {
      const Vector t = i * a + j * b;
      if (t.x < bounds.low.x || t.x > bounds.high.x || t.y < bounds.low.y || t.y > bounds.high.y)
        continue;
      if (found.size() == most) return std::nullopt;
      const auto m = static_cast<std::int64_t>(i), n = static_cast<std::int64_t>(j);
      found.push_back({m * cell_a.first + n * cell_b.first, m * cell_a.second + n * cell_b.second});
    }
  }
  std::sort(found.begin(), found.end(), [](const Cell& x, const Cell& y) {
    return x.first != y.first ? x.first < y.first : x.second < y.second;
  });
  return found;
}

}  // namespace carom::geometry
