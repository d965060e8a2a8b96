#include "carom/trust/trust.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "carom/geometry/curve_frame.hpp"
#include "carom/motion/tangent.hpp"
#include "trust/error_edges.hpp"
#include "trust/exact_hit.hpp"

namespace carom {

using namespace trust;
using geometry::Vector;

namespace {

struct Box {
  double left = 0, right = 0, bottom = 0, top = 0;
};
Box box_of(const Table& table) {
  Box b;
  bool first = true;
  const auto take = [&](Vector p) {
    if (first) b = {p.x, p.x, p.y, p.y};
    first = false;
    b = {std::min(b.left, p.x), std::max(b.right, p.x), std::min(b.bottom, p.y),
         std::max(b.top, p.y)};
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
  if (table.lattice)
    return std::max(length_of(table.lattice->first), length_of(table.lattice->second));
  const Box b = box_of(table);
  return std::max(b.right - b.left, b.top - b.bottom);
}

class TrustRecorder::Implementation {
 public:
  Implementation(const Table& the_table, double the_tolerance,
                 std::shared_ptr<const WrittenSystem> written)
      : table(the_table),
        tolerance(the_tolerance),
        size(size_of(the_table)),
        as_written(std::move(written)),
        edges(the_table) {}

  struct Track {
    Particle particle;
    State state;  ///< after the last event
    Trust trust;
    std::shared_ptr<const WrittenSystem> system;
  };

  /// The error of the state at one time, to first order.
  static Deviation at_one_time(const Particle& particle, const State& state, const OrbitError& e) {
    const Vector v = state.velocity;
    return {e.position - e.time * v, e.velocity - (particle.omega * e.time) * right(v)};
  }
  /// Beyond the true orbit: a neighbour as far as the margin says, and a few roundings more across
  /// the flight.
  Deviation edge_of(const Track& track) const {
    const Vector v = track.state.velocity, side = left(v);
    const Deviation e = at_one_time(track.particle, track.state, track.trust.error);
    const double sign = dot(side, e.position) < 0.0 ? -1.0 : 1.0;
    Deviation edge = margin * e;
    edge.position =
        edge.position + (sign * 4.0 * geometry::unit_roundoff * size / length_of(v)) * side;
    return edge;
  }
  /// A neighbour that arrives later than this arrives elsewhere.
  double latest(const Particle& particle, double duration) const {
    return duration + 3.0 * tolerance * size / particle.speed;
  }
  bool hit(Track& track, const HitEvent& event);
  bool left_in_time(const Track& track, const EndEvent& event) const;

  const Table& table;
  double tolerance, size;
  std::shared_ptr<const WrittenSystem> as_written;
  ErrorEdges edges;
  std::vector<Track> tracks;
};

/// False: the errors are too large to say that this hit is the true orbit's.
bool TrustRecorder::Implementation::hit(Track& track, const HitEvent& event) {
  // At a joint the least error decides which wall it is.
  if (event.u == 0.0 || event.reflections != 1) return false;
  const Particle& particle = track.particle;
  const std::optional<OrbitError> e =
      error_after(*track.system, track.state, track.trust.error, event);
  if (!e) return false;
  const ErrorEdges::Arrival arrival{event.wall, event.cell, event.position};
  // A tolerance may be finer than the roundings by which edges are displaced.
  const double roundings = 16.0 * geometry::unit_roundoff * size,
               farthest = tolerance * size + roundings;
  if (!edges.surely_same_arrival(particle, event, length_of(e->position) + roundings) &&
      !edges.same_arrival(particle, track.state, edge_of(track), arrival, farthest,
                          latest(particle, event.flight_time)))
    return false;

  const auto within = [](double error, double bound) { return margin * error <= bound; };
  if (!(within(length_of(e->position), tolerance * size) &&
        within(std::fabs(e->time) * particle.speed, tolerance * size) &&
        within(length_of(e->velocity), tolerance * particle.speed)))
    return false;
  track.trust.error = *e;
  return true;
}

/// Are the point and the time of the escape right? (On a lattice the hole's copy is not known.)
bool TrustRecorder::Implementation::left_in_time(const Track& track, const EndEvent& event) const {
  if (table.lattice) return true;
  const Particle& particle = track.particle;
  const State& from = track.state;
  const FlightTangent flight = flight_tangent(particle.omega, event.time - from.time);
  const Deviation there = flight({from.position, from.velocity});  // the flight itself is as linear
  const Wall& wall =
      table.walls[static_cast<std::size_t>(table.holes[static_cast<std::size_t>(event.hole)].wall)];
  const geometry::CurveFrame frame = geometry::frame_of(wall.curve);
  const Vector normal = geometry::normal_at(frame, geometry::parameter_of(frame, there.position));
  const AtWall at = at_wall(normal, there.velocity, particle.omega);
  const Deviation e = flight(at_one_time(particle, from, track.trust.error));
  const double farthest =
      std::max(std::fabs(dot(at.arc, e)), std::fabs(dot(at.delay, e)) * particle.speed);
  return margin * farthest <= tolerance * size && margin * std::fabs(dot(at.angle, e)) <= tolerance;
}

TrustRecorder::TrustRecorder(const Table& table, double tolerance,
                             std::shared_ptr<const WrittenSystem> written)
    : implementation_(std::make_unique<Implementation>(table, tolerance, std::move(written))) {}
TrustRecorder::~TrustRecorder() = default;

void TrustRecorder::follow(const Particle& particle, const State& state, std::uint64_t hits,
                           const Trust* before) {
  Implementation& a = *implementation_;
  Implementation::Track track{particle, state, {}, a.as_written};
  const bool first = a.tracks.empty();
  // The numbers that were written are the first particle's.
  if (!track.system || !first) {
    const WrittenSystem stored = as_stored(a.table, particle);
    if (track.system) {
      WrittenSystem own = *track.system;
      own.omega = stored.omega;
      own.speed = stored.speed;
      track.system = std::make_shared<const WrittenSystem>(std::move(own));
    } else {
      track.system = std::make_shared<const WrittenSystem>(stored);
    }
  }
  if (before != nullptr) {
    track.trust = *before;
  } else {
    track.trust.known = track.trust.open = true;
    track.trust.hits = hits;
    track.trust.time = state.time;
    track.trust.error = error_of_start(*track.system, state, first);
  }
  a.tracks.push_back(std::move(track));
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
  track.trust.open = a.left_in_time(track, event) &&
                     a.edges.same_hole(track.particle, track.state, a.edge_of(track), event.hole,
                                       a.latest(track.particle, event.time - track.state.time));
}

const Trust& TrustRecorder::trust(int particle) const {
  return implementation_->tracks[static_cast<std::size_t>(particle)].trust;
}

Trust TrustRecorder::at_end(const Particle& particle, const State& state, const Trust& before,
                            Time end) const {
  const Implementation& a = *implementation_;
  Trust trust = before;
  const double duration = end - state.time;
  if (!trust.open || !(duration > 0.0)) return trust;
  const Deviation e = flight_tangent(
      particle.omega, duration)(Implementation::at_one_time(particle, state, trust.error));
  if (margin * length_of(e.position) <= a.tolerance * a.size &&
      margin * length_of(e.velocity) <= a.tolerance * particle.speed)
    trust.time = end;
  return trust;
}

}  // namespace carom
