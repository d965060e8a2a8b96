#include "carom/analysis/trust.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "analysis/error_edges.hpp"
#include "carom/geometry/curve_frame.hpp"

namespace carom {

using geometry::Vector;

namespace {

constexpr double u = geometry::unit_roundoff;

double component(const Deviation& d, std::size_t i) {
  return i < 2 ? (i == 0 ? d.position.x : d.position.y) : i == 2 ? d.velocity.x : d.velocity.y;
}
ErrorSpread transposed(const ErrorSpread& m) {
  ErrorSpread t;
  for (std::size_t i = 0; i < 4; ++i)
    t[i] = {{component(m[0], i), component(m[1], i)}, {component(m[2], i), component(m[3], i)}};
  return t;
}
/// M P M^T.
template <class Map>
ErrorSpread carried(const Map& map, ErrorSpread p) {
  for (Deviation& column : p) column = map(column);
  p = transposed(p);
  for (Deviation& column : p) column = map(column);
  return p;
}
void add_noise(ErrorSpread& p, double position, double velocity) {
  p[0].position.x += position * position;
  p[1].position.y += position * position;
  p[2].velocity.x += velocity * velocity;
  p[3].velocity.y += velocity * velocity;
}
Deviation product(const ErrorSpread& p, const Deviation& g) {
  return (g.position.x * p[0] + g.position.y * p[1]) + (g.velocity.x * p[2] + g.velocity.y * p[3]);
}
double deviation_of(const ErrorSpread& p, const Deviation& g) {
  const double square = dot(g, product(p, g));
  return square > 0.0 ? std::sqrt(square) : 0.0;
}

struct Box {
  double left = 0, right = 0, bottom = 0, top = 0;
};
Box box_of(const Table& table) {
  Box b;
  bool first = true;
  const auto take = [&](Vector p) {
    if (first) b = {p.x, p.x, p.y, p.y};
    first = false;
    b = {std::min(b.left, p.x), std::max(b.right, p.x), std::min(b.bottom, p.y), std::max(b.top, p.y)};
  };
  for (const Wall& wall : table.walls) {
    const geometry::Box box = geometry::bounding_box(wall.curve);
    take(box.low);
    take(box.high);
  }
  if (table.lattice)
    for (const geometry::CellEdge& edge : table.lattice->edges) take(edge.segment.from);
  return b;
}

double length_of(Vector v) { return std::sqrt(dot(v, v)); }

}  // namespace

double size_of(const Table& table) {
  if (table.lattice) return std::max(length_of(table.lattice->first), length_of(table.lattice->second));
  const Box b = box_of(table);
  return std::max(b.right - b.left, b.top - b.bottom);
}

class TrustRecorder::Implementation {
 public:
  Implementation(const Table& the_table, double the_tolerance)
      : table(the_table), tolerance(the_tolerance), size(size_of(the_table)), edges(the_table) {
    const Box b = box_of(table);
    extent = std::max({std::fabs(b.left), std::fabs(b.right), std::fabs(b.bottom), std::fabs(b.top)});
    for (const Wall& wall : table.walls) frames.push_back(geometry::frame_of(wall.curve));
  }

  struct Track {
    Particle particle;
    State state;  ///< after the last event
    Trust trust;
    HitError error;
  };

  // Bounds of what one flight and one hit add (docs/physics/tangent-map.md).
  double position_noise(double way) const { return 2.0 * u * (extent + way); }
  double angle_noise(double curvature, double turn) const {
    return 2.0 * u * (1.0 + extent * std::fabs(curvature) + std::fabs(turn));
  }

  ErrorSpread flown(const ErrorSpread& before, const FlightTangent& flight, double way) const {
    ErrorSpread p = carried(flight, before);
    add_noise(p, position_noise(way), 0.0);
    return p;
  }
  /// The likeliest deviation at the start of a flight that is on the edge of the beam at its end: the
  /// deviation across the flight there decides where and whether a wall is met.
  Deviation edge_of(const Track& track, const FlightTangent& flight) const {
    const Vector v = track.state.velocity;
    const Vector arriving = flight.c * v + flight.s * right(v);
    const Deviation across = flight.before({left(arriving), {}});
    const Deviation worst = product(track.trust.spread, across);
    const double square = dot(across, worst);
    return square > 0.0 ? (deviations / std::sqrt(square)) * worst : Deviation();
  }
  /// Who arrives later than this arrives elsewhere.
  double latest(const Particle& particle, double duration) const {
    return duration + 3.0 * tolerance * size / particle.speed;
  }
  bool hit(Track& track, const HitEvent& event);

  const Table& table;
  double tolerance, size, extent = 0.0;
  std::vector<geometry::CurveFrame> frames;
  ErrorEdges edges;
  std::vector<Track> tracks;
};

/// False: the errors are too large to say that this hit is the true orbit's.
bool TrustRecorder::Implementation::hit(Track& track, const HitEvent& event) {
  // At a joint the least error decides which wall it is.
  if (event.u == 0.0 || event.reflections != 1) return false;
  const Particle& particle = track.particle;
  const geometry::CurveFrame& frame = frames[static_cast<std::size_t>(event.wall)];
  const Vector normal = geometry::normal_at(frame, event.u);
  const double curvature = geometry::curvature_at(frame, event.u);
  const FlightTangent flight = flight_tangent(particle.omega, event.flight_time);

  const ErrorEdges::Arrival arrival{event.wall, event.cell, event.position};
  const Deviation edge = edge_of(track, flight);
  for (const double sign : {1.0, -1.0})
    if (!edges.same_arrival(particle, track.state, sign * edge, arrival, tolerance * size,
                            latest(particle, event.flight_time)))
      return false;

  ErrorSpread p = flown(track.trust.spread, flight, particle.speed * event.flight_time);
  p = carried(reflection_tangent(normal, curvature, event.before, particle.omega), p);
  add_noise(p, 0.0, particle.speed * angle_noise(curvature, particle.omega * event.flight_time));
  const AtWall at = at_wall(normal, event.after, particle.omega);
  track.error = {deviations * deviation_of(p, at.arc), deviations * deviation_of(p, at.delay),
                 deviations * deviation_of(p, at.angle)};
  if (!(track.error.arc <= tolerance * size && track.error.delay * particle.speed <= tolerance * size &&
        track.error.angle <= tolerance))
    return false;
  track.trust.spread = p;
  return true;
}

TrustRecorder::TrustRecorder(const Table& table, double tolerance)
    : implementation_(std::make_unique<Implementation>(table, tolerance)) {}
TrustRecorder::~TrustRecorder() = default;

void TrustRecorder::follow(const Particle& particle, const State& state, std::uint64_t hits,
                           const Trust* before) {
  Implementation& a = *implementation_;
  Implementation::Track track{particle, state, {}, {}};
  if (before != nullptr) {
    track.trust = *before;
  } else {
    track.trust.known = track.trust.open = true;
    track.trust.hits = hits;
    track.trust.time = state.time;
    // The engine puts the speed back to its value at every hit; the start may have missed it.
    const double missed = std::fabs(length_of(state.velocity) - particle.speed);
    add_noise(track.trust.spread, a.position_noise(0.0), missed + 2.0 * u * particle.speed);
  }
  a.tracks.push_back(track);
}

void TrustRecorder::hit(const HitEvent& event) {
  Implementation::Track& track = implementation_->tracks[static_cast<std::size_t>(event.particle)];
  Trust& trust = track.trust;
  if (!trust.open) return;
  trust.open = implementation_->hit(track, event);
  if (!trust.open) return;
  trust.hits += static_cast<std::uint64_t>(event.reflections);
  trust.time = event.time;
  track.state.wall = event.wall;
  track.state.u = event.u;
  track.state.position = event.position;
  track.state.velocity = event.after;
  track.state.cell = event.cell;
  track.state.time = event.time;
}

void TrustRecorder::end(const EndEvent& event) {
  Implementation& a = *implementation_;
  Implementation::Track& track = a.tracks[static_cast<std::size_t>(event.particle)];
  if (!track.trust.open || event.fate != Fate::escaped) return;
  const FlightTangent flight = flight_tangent(track.particle.omega, event.time - track.state.time);
  const Deviation edge = a.edge_of(track, flight);
  for (const double sign : {1.0, -1.0})
    track.trust.open =
        track.trust.open && a.edges.same_hole(track.particle, track.state, sign * edge, event.hole,
                                              a.latest(track.particle, event.time - track.state.time));
}

const Trust& TrustRecorder::trust(int particle) const {
  return implementation_->tracks[static_cast<std::size_t>(particle)].trust;
}
const HitError& TrustRecorder::last_error(int particle) const {
  return implementation_->tracks[static_cast<std::size_t>(particle)].error;
}

Trust TrustRecorder::at_end(const Particle& particle, const State& state, const Trust& before,
                            Time end) const {
  const Implementation& a = *implementation_;
  Trust trust = before;
  const double duration = end - state.time;
  if (!trust.open || !(duration > 0.0)) return trust;
  const ErrorSpread p =
      a.flown(trust.spread, flight_tangent(particle.omega, duration), particle.speed * duration);
  const double position = std::sqrt(p[0].position.x + p[1].position.y);
  const double velocity = std::sqrt(p[2].velocity.x + p[3].velocity.y);
  if (deviations * position <= a.tolerance * a.size && deviations * velocity <= a.tolerance * particle.speed)
    trust.time = end;
  return trust;
}

}  // namespace carom
