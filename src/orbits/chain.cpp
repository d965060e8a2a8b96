#include "orbits/chain.hpp"

#include <algorithm>
#include <cmath>

#include "carom/base/elementary.hpp"

namespace carom::orbits {

using geometry::Vector;

namespace {

double sign_of_turn(const Boundary& boundary) { return boundary.particle.omega > 0.0 ? 1.0 : -1.0; }
bool has_field(const Boundary& boundary) { return boundary.particle.omega != 0.0; }

}  // namespace

ChainGeometry geometry_of(const Boundary& boundary, const Chain& chain) {
  ChainGeometry g;
  for (const Link& link : chain) g.points.push_back(wall_point(boundary, link.wall, link.u));
  const std::size_t n = chain.size();
  const double turn = has_field(boundary) ? sign_of_turn(boundary) : 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    Vector to = g.points[(i + 1) % n].position;
    if (boundary.table->lattice) to = to + boundary.table->lattice->translation(chain[i].step);
    const Vector chord = to - g.points[i].position;
    ChainFlight flight;
    flight.chord = std::sqrt(dot(chord, chord));
    flight.direction = (1.0 / flight.chord) * chord;
    if (turn != 0.0) {
      const elementary::SinCos half = elementary::sincos(chain[i].half_turn);
      flight.sine = half.sin, flight.cosine = half.cos;
    }
    const Vector along = flight.cosine * flight.direction;
    const Vector across = (turn * flight.sine) * left(flight.direction);
    flight.departure = along + across;
    flight.arrival = along - across;
    g.shortest = i == 0 ? flight.chord : std::min(g.shortest, flight.chord);
    g.flights.push_back(flight);
  }
  return g;
}

std::size_t equations(const Boundary& boundary, const Chain& chain) {
  return has_field(boundary) ? 2 * chain.size() : chain.size();
}

std::vector<double> residual(const Boundary& boundary, const ChainGeometry& g) {
  const std::size_t n = g.points.size();
  std::vector<double> sides;
  for (std::size_t i = 0; i < n; ++i) {
    const ChainFlight &in = g.flights[(i + n - 1) % n], &out = g.flights[i];
    sides.push_back(dot(g.points[i].tangent, in.arrival - out.departure));
  }
  if (has_field(boundary)) {
    const double k = std::abs(boundary.flight_curvature());
    for (const ChainFlight& flight : g.flights)
      sides.push_back(flight.sine - 0.5 * k * flight.chord);
  }
  return sides;
}

double residual_error(const Boundary& boundary, const ChainGeometry& g) {
  return unit_roundoff * (48.0 * boundary.size / g.shortest + 34.0);
}

double error_of_pieces(const Boundary& boundary, const ChainGeometry& g) {
  const CurveErrors& off = boundary.table->curve_errors;
  return 4.0 * off.distance / g.shortest + 2.0 * off.normal;
}

std::vector<double> derivatives(const Boundary& boundary, const ChainGeometry& g) {
  const std::size_t n = g.points.size();
  const bool field = has_field(boundary);
  const std::size_t size = field ? 2 * n : n;
  const double turn = sign_of_turn(boundary), k = std::abs(boundary.flight_curvature());
  std::vector<double> matrix(size * size, 0.0);
  const auto add = [&](std::size_t row, std::size_t column, double value) {
    matrix[row * size + column] += value;
  };
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t j = (i + 1) % n;
    const WallPoint &a = g.points[i], &b = g.points[j];
    const ChainFlight &flight = g.flights[i], &in = g.flights[(i + n - 1) % n];
    add(i, i, a.curvature * dot(a.normal, in.arrival - flight.departure));
    // The chord turns by these angles where its ends move along their walls.
    const Vector across = left(flight.direction);
    const double by_a = -dot(across, a.tangent) / flight.chord;
    const double by_b = dot(across, b.tangent) / flight.chord;
    const double leaves = -dot(a.tangent, left(flight.departure));
    const double arrives = dot(b.tangent, left(flight.arrival));
    add(i, i, leaves * by_a);
    add(i, j, leaves * by_b);
    add(j, i, arrives * by_a);
    add(j, j, arrives * by_b);
    if (!field) continue;
    add(i, n + i, leaves * turn);
    add(j, n + i, -arrives * turn);
    add(n + i, n + i, flight.cosine);
    add(n + i, i, 0.5 * k * dot(flight.direction, a.tangent));
    add(n + i, j, -0.5 * k * dot(flight.direction, b.tangent));
  }
  return matrix;
}

bool move(const Boundary& boundary, Chain& chain, const std::vector<double>& step, double factor) {
  const std::size_t n = chain.size();
  bool left_wall = false;
  for (std::size_t i = 0; i < n; ++i) {
    Link& link = chain[i];
    const WallPlace moved = moved_along(boundary, {link.wall, link.u}, factor * step[i], left_wall);
    link.wall = moved.wall;
    link.u = moved.u;
    if (has_field(boundary)) link.half_turn += factor * step[n + i];
  }
  return !left_wall;
}

double length_of(const Boundary& boundary, const Chain& chain, const ChainGeometry& g) {
  const double k = std::abs(boundary.flight_curvature());
  double sum = 0.0;
  for (std::size_t i = 0; i < chain.size(); ++i)
    sum += has_field(boundary) ? 2.0 * chain[i].half_turn / k : g.flights[i].chord;
  return sum;
}

double area_of(const Boundary& boundary, const Chain& chain, const ChainGeometry& g) {
  const std::size_t n = chain.size();
  const double k = std::abs(boundary.flight_curvature());
  double twice = 0.0;
  Vector offset;  // of the cell that the flight leaves from
  for (std::size_t i = 0; i < n; ++i) {
    const Vector from = g.points[i].position + offset;
    if (boundary.table->lattice)
      offset = offset + boundary.table->lattice->translation(chain[i].step);
    twice += cross(from, g.points[(i + 1) % n].position + offset);
    if (!has_field(boundary)) continue;
    // A clockwise flight bends to the left of its chord: forth along it and back along the chord
    // is clockwise. Half-turns near 0 lose digits here that omega makes small again.
    const ChainFlight& flight = g.flights[i];
    twice -=
        sign_of_turn(boundary) * 2.0 * (chain[i].half_turn - flight.sine * flight.cosine) / (k * k);
  }
  return 0.5 * twice;
}

}  // namespace carom::orbits
