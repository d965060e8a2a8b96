// The periodic cubic spline whose parameter grows by the length of the chords, in any arithmetic.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "carom/geometry/vector.hpp"

namespace carom::table::shapes {

/// Solves l[k] x[k-1] + d[k] x[k] + u[k] x[k+1] = r[k] around a circle: Thomas' algorithm with the
/// corners as a correction of rank one. Diagonally dominant, so without pivots.
template <class N>
std::vector<geometry::BasicVector<N>> solve_around(const std::vector<N>& l, std::vector<N> d,
                                                   const std::vector<N>& u,
                                                   std::vector<geometry::BasicVector<N>> r) {
  const std::size_t n = d.size();
  const N corner = -d[0];
  std::vector<N> z(n, N(0.0));
  z[0] = corner;
  z[n - 1] = u[n - 1];
  d[0] = d[0] - corner;
  d[n - 1] = d[n - 1] - l[0] * u[n - 1] / corner;
  for (std::size_t k = 1; k < n; ++k) {
    const N share = l[k] / d[k - 1];
    d[k] = d[k] - share * u[k - 1];
    r[k] = r[k] - share * r[k - 1];
    z[k] = z[k] - share * z[k - 1];
  }
  for (std::size_t k = n; k-- > 0;) {
    const bool last = k + 1 == n;
    r[k] = (N(1.0) / d[k]) * (last ? r[k] : r[k] - u[k] * r[k + 1]);
    z[k] = (last ? z[k] : z[k] - u[k] * z[k + 1]) / d[k];
  }
  const N back = l[0] / corner, weight = N(1.0) + z[0] + back * z[n - 1];
  const geometry::BasicVector<N> share = (N(1.0) / weight) * (r[0] + back * r[n - 1]);
  for (std::size_t k = 0; k < n; ++k) r[k] = r[k] - z[k] * share;
  return r;
}

/// The control points of its pieces. No point may be there twice in a row.
template <class N>
std::vector<std::vector<geometry::BasicVector<N>>> spline_pieces(
    const std::vector<geometry::BasicVector<N>>& points) {
  using std::sqrt;
  const std::size_t n = points.size();
  std::vector<N> chord(n), l(n), d(n), u(n);
  std::vector<geometry::BasicVector<N>> r(n);
  for (std::size_t k = 0; k < n; ++k) {
    const geometry::BasicVector<N> e = points[(k + 1) % n] - points[k];
    chord[k] = sqrt(dot(e, e));
  }
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t before = (k + n - 1) % n, next = (k + 1) % n;
    const N a = chord[before], b = chord[k];
    l[k] = b;
    d[k] = N(2.0) * (a + b);
    u[k] = a;
    r[k] = (N(3.0) * b / a) * (points[k] - points[before]) +
           (N(3.0) * a / b) * (points[next] - points[k]);
  }
  const std::vector<geometry::BasicVector<N>> slope = solve_around(l, d, u, r);
  std::vector<std::vector<geometry::BasicVector<N>>> pieces;
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t next = (k + 1) % n;
    const N third = chord[k] / N(3.0);
    pieces.push_back({points[k], points[k] + third * slope[k], points[next] - third * slope[next],
                      points[next]});
  }
  return pieces;
}

}  // namespace carom::table::shapes
