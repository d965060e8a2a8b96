// Free particles: flights from wall to wall.
//
// These are the functions where the time of a run goes. They are inlined into the event loop, so
// that its numbers stay in registers from landing to the next hit.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "carom/base/random.hpp"
#include "events/bodies.hpp"
#include "events/flight/locator.hpp"
#include "events/flight/media.hpp"
#include "events/flight/next_hit.hpp"
#include "events/step/force_regions.hpp"
#include "motion/free_motion.hpp"

namespace carom::events {

class FreeFlights {
 public:
  /// `pieces`: of the walls that flights meet. `inside`: the table, without edges of supports, that
  /// points are inside of.
  /// `media`: the table's regions, null: it has none.
  FreeFlights(const PieceTable& pieces, const Table& inside, const ForceRegions& regions,
              Bodies& bodies, std::shared_ptr<const Media> media);

  /// Applies what comes first for a free body. False if a flight does not go on by itself: the body
  /// is where forces act from now on, or is to be looked after because another body may be near.
  bool apply(int index, Time now, Observer& observer);
  /// The same for callers that it is not inlined into.
  bool apply_apart(int index, Time now, Observer& observer);

  /// Applies hits of a body that is alone as long as there is nothing else to attend to, at most so
  /// many, with its flight in local variables. Returns how many; what it leaves is for `apply`.
  std::uint64_t apply_hits(int index, double t_end, std::uint64_t most, Observer& observer);

  /// Throws std::invalid_argument unless the velocity has the length of the particle's speed.
  void check_speed(const Body& b) const;
  /// Starts a flight from the body's state. Throws std::invalid_argument if its velocity leads out
  /// of the domain.
  void begin(Body& b) const;
  /// Starts a flight from a point on a wall; the particle's speed is that of its velocity.
  void begin_on_wall(Body& b, int wall, double u) const;
  /// Finds what comes first on the flight, and schedules it.
  void predict(int index);
  /// Schedules what is known to come first on the flight.
  void schedule(int index);

  /// Is the point strictly inside (exact), or in a region?
  bool contains(geometry::Vector point);
  /// Puts a body that has not flown yet into the region that its state is in. Its velocity may have
  /// the length of the speed outside; then it gets that of the speed there.
  void enter(Body& b);
  const std::shared_ptr<const Media>& media() const { return media_; }

  /// As World::scatter_by.
  void scatter_by(std::uint64_t seed, std::uint64_t trajectory, std::vector<int> numbers) {
    scattering_ = {scattering_.any, scattering_.thermal, seed, trajectory, std::move(numbers)};
  }

  /// From now on a flight is not taken over an edge of its cell before it gets there: for bodies
  /// that meet others.
  void keep_to_cells() { over_edges_ = false; }

  /// Do walls change speeds?
  bool change_speeds() const { return scattering_.thermal; }

  const PieceTable& pieces() const { return finder_.pieces(); }
  DecisionCounts& counts() { return counts_; }
  const DecisionCounts& counts() const { return counts_; }

 private:
  void predict(int index, Body& b);
  void schedule(int index, const Body& b);
  // Of tables with regions (regions.cpp).
  const PieceTable& pieces_of(int region) const {
    return region < 0 ? pieces() : media_->pieces_of(region);
  }
  int first_wall(const Body& b) const { return media_ ? media_->first_wall(b.region) : 0; }
  bool passes(const Body& b) const {
    return b.region >= 0 || media_->twin(pieces().wall_of(b.ahead.piece)) >= 0;
  }
  void predict_in_region(int index);
  void pass(int index, Time now, Observer& observer);
  void put_into(Body& b, int region) const;
  RandomStream::Block words_of(int index, const Body& b, Purpose purpose) const;
  bool lets_pass(int index, const Body& b, int hole) const;
  enum class Passage { passed, mirrored, unknown };
  Passage cross(int index, Body& b, const PieceTable::Landing& landing);
  /// In which region a point of the cell is, and the cell of that region's walls.
  struct InRegion {
    int region = -1;
    geometry::Cell cell;
    geometry::Vector position;  ///< in that cell
  };
  InRegion place_in_region(geometry::Vector point);
  bool outside_contains(geometry::Vector point);
  geometry::Vector scattered(int index, Body& b, const PieceTable& pieces,
                             const PieceTable::Landing& landing, geometry::Vector mirrored);
  void add_corners(const PieceTable& pieces);
  static void set_speed(Body& b, double speed);
  static geometry::Vector mirrored(const Body& b, geometry::Vector before,
                                   const geometry::PreparedCurve::Arrival& at) {
    return geometry::reflected(before, at.normal, at.factor, step_to_energy_shell(before, b.shell));
  }
  static void put_on_wall(Body& b, int wall, Time now, const geometry::PreparedCurve::Arrival& at,
                          geometry::Vector velocity);
  enum class Alone;
  template <Alone alone>
  void finish_hits(int index, Body& b, Ahead ahead, DecisionCounts counts, std::uint64_t hits);
  template <Alone alone>
  std::uint64_t apply_hits(int index, double t_end, std::uint64_t most, Observer& observer);
  /// The flight begins at the body's state on a wall; it stays in its cell.
  void begin_off_joints(Body& b) const {
    const State& s = b.state;
    PieceTable::put_on_wall(b.flight, s.wall, pieces().curve(s.wall), s.u, s.position, s.velocity);
  }
  static void put_on_edge(Body& b, Time now, const PieceTable::Landing& landing);
  /// At a wall of these pieces that the body does not pass. `first`: the number of their first wall
  /// in the table, 0 outside of regions.
  bool meet(int index, Body& b, Time now, Observer& observer, const PieceTable& pieces, int first,
            PieceTable::Landing& landing);
  bool reflect(int index, Body& b, Time now, Observer& observer, const PieceTable& pieces,
               int first, const PieceTable::Landing& landing);

  HitFinder finder_;
  bool over_edges_;
  bool plain_;  ///< all walls are mirrors without holes, and no forces act
  Bodies& bodies_;
  const ForceRegions& regions_;
  struct Scattering {
    bool any = false, thermal = false;  ///< does a wall?
    std::uint64_t seed = 0, trajectory = 0;
    std::vector<int> numbers;  ///< of bodies; empty: their indices
  } scattering_;
  const std::shared_ptr<const Media> media_;
  struct Medium {
    HitFinder finder;
    std::unique_ptr<Locator> locator;
  };
  std::vector<Medium> media_of_table_;
  std::vector<int> corners_;  ///< order n of the corner at each wall's start, 0: no law holds
  DecisionCounts counts_;
  const Table& inside_;
  std::unique_ptr<Locator> locator_;  ///< made when it is asked for the first time
};

[[gnu::always_inline]] inline void FreeFlights::predict(int index, Body& b) {
  if (!finder_.next_in_convex(b.flight, b.ahead, counts_)) {
    if (over_edges_)
      finder_.next_over_edges(b.flight, b.ahead, counts_);
    else
      finder_.next_in_any(b.flight, b.ahead, counts_);
  }
  schedule(index, b);
}

[[gnu::always_inline]] inline void FreeFlights::schedule(int index, const Body& b) {
  Time when = b.state.time + b.ahead.duration;
  EventKind kind = EventKind::hit;
  switch (b.ahead.kind) {
    case Ahead::Kind::wall:
      break;
    case Ahead::Kind::edge:
      kind = EventKind::cell_edge;
      break;
    case Ahead::Kind::joint:
    case Ahead::Kind::cusp:
      kind = EventKind::singular;
      break;
    case Ahead::Kind::none:
      when = b.state.time;
      if (b.particle.omega != 0.0 && b.state.wall < 0)
        kind = EventKind::pinned;
      else if (b.particle.omega == 0.0 && b.region < 0 &&
               pieces().table.extent == Extent::open_plane)
        kind = EventKind::unbounded;
      else
        kind = EventKind::lost;
      break;
  }
  if (regions_.by_range()) {
    // Nothing but another particle may lie ahead.
    if (kind == EventKind::pinned || kind == EventKind::unbounded) when = never;
    if (b.check < when) {
      when = b.check;
      kind = EventKind::group;
    }
  }
  bodies_.schedule(index, when, kind);
}

[[gnu::always_inline]] inline void FreeFlights::put_on_wall(
    Body& b, int wall, Time now, const geometry::PreparedCurve::Arrival& at,
    geometry::Vector velocity) {
  b.state.wall = wall;
  b.state.u = at.u;
  b.state.position = at.point;
  b.state.velocity = velocity;
  b.state.time.high = now.high;
  b.state.time.low = now.low;
}

[[gnu::always_inline]] inline bool FreeFlights::reflect(int index, Body& b, Time now,
                                                        Observer& observer,
                                                        const PieceTable& pieces, int first,
                                                        const PieceTable::Landing& landing) {
  const geometry::Vector before = landing.velocity;
  const geometry::Vector normal = landing.at.normal;
  geometry::Vector after;
  int reflections = 1;
  if (b.ahead.kind == Ahead::Kind::joint) {
    reflections = corners_[static_cast<std::size_t>(first + landing.wall)];
    if (reflections == 0) return bodies_.end(index, Fate::singular, now, observer), true;
    const int previous = pieces.table.walls[static_cast<std::size_t>(landing.wall)].previous;
    const double step = step_to_energy_shell(before, b.shell);
    after = (1.0 + step) * motion::reflected_at_corner(before, pieces.normal_at_end(previous),
                                                       normal, reflections);
  } else {
    after = mirrored(b, before, landing.at);
  }
  if (scattering_.any) [[unlikely]] {
    const PieceTable::Landing there = landing;  // a copy, or the landing would live in memory
    after = scattered(index, b, pieces, there, after);
  }
  Sign inward = pieces.inward(landing.wall, *landing.curve, landing.at.u, after, normal, counts_);
  if (inward == Sign::negative && reflections == 1) {
    // A grazing rounding: reflecting once more turns it back.
    after = geometry::reflected(after, normal, dot(normal, normal), 1.0, 0.0);
    inward = pieces.inward(landing.wall, *landing.curve, landing.at.u, after, normal, counts_);
  }
  if (inward != Sign::positive) return bodies_.end(index, Fate::singular, now, observer), true;

  put_on_wall(b, first + landing.wall, now, landing.at, after);
  b.state.cell.first += landing.cell.first;
  b.state.cell.second += landing.cell.second;
  pieces.begin_on_wall(b.flight, landing.wall, *landing.curve, landing.at.u, landing.at.point,
                       after);
  const HitEvent& hit = bodies_.count_hit(index, b, b.state, before, b.ahead.duration, reflections);
  if (bodies_.reaches_limit(b)) {
    observer.hit(hit);
    return bodies_.end(index, Fate::capped, now, observer), true;
  }
  if (!regions_.edges().empty() && regions_.hold(b.state.position)) [[unlikely]] {
    observer.hit(hit);
    return false;  // an edge meets the wall there, and the flight would be beyond it
  }
  // First, while its numbers are at hand.
  if (first == 0)
    predict(index, b);
  else
    predict_in_region(index);
  observer.hit(hit);
  return true;
}

[[gnu::always_inline]] inline bool FreeFlights::meet(int index, Body& b, Time now,
                                                     Observer& observer, const PieceTable& pieces,
                                                     int first, PieceTable::Landing& landing) {
  if (b.ahead.kind == Ahead::Kind::joint) {
    for (const int h : pieces.table.walls[static_cast<std::size_t>(landing.wall)].holes)
      if (pieces.table.holes[static_cast<std::size_t>(h)].from == 0.0) landing.hole = h;
  }
  if (landing.hole >= 0 && (!scattering_.any || lets_pass(index, b, landing.hole))) {
    b.hole = landing.hole;
    return bodies_.end(index, Fate::escaped, now, observer), true;
  }
  return reflect(index, b, now, observer, pieces, first, landing);
}

[[gnu::always_inline]] inline bool FreeFlights::apply(int index, Time now, Observer& observer) {
  Body& b = bodies_[index];
  const EventKind kind = bodies_.what(index);
  if (kind != EventKind::hit) switch (kind) {
      case EventKind::pinned:
        return bodies_.end(index, Fate::pinned, now, observer), true;
      case EventKind::unbounded:
        return bodies_.end(index, Fate::unbounded, b.state.time, observer), true;
      case EventKind::cell_edge:
        pieces().cross(b.flight, b.ahead);
        return predict(index, b), true;
      case EventKind::hit:
      case EventKind::singular:
        break;
      case EventKind::group:
        return false;
      default:
        return bodies_.end(index, Fate::lost, b.state.time, observer), true;
    }
  if (b.ahead.kind == Ahead::Kind::cusp)
    return bodies_.end(index, Fate::singular, now, observer), true;
  if (media_ != nullptr && passes(b)) [[unlikely]]
    return pass(index, now, observer), true;
  PieceTable::Landing landing;
  pieces().land(b.flight, b.ahead, landing, counts_);
  if (regions_.is_edge(landing.wall)) [[unlikely]] {
    const PieceTable::Landing there = landing;  // a copy, or the landing would live in memory
    put_on_edge(b, now, there);
    return false;
  }
  return meet(index, b, now, observer, pieces(), 0, landing);
}

}  // namespace carom::events
