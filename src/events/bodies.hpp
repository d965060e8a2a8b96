// The particles of a world: where each of them is, when something happens to it next, and how it
// ends.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "carom/events/observer.hpp"
#include "carom/geometry/formulas.hpp"
#include "carom/motion/state.hpp"
#include "events/flight/flight.hpp"
#include "events/queue.hpp"

namespace carom::events {

class Group;

inline constexpr Time never{std::numeric_limits<double>::infinity()};

/// A particle. It flies freely, or belongs to a group.
struct Body {
  Particle particle;  ///< as it is where it is: in its region
  geometry::EnergyShell<double> shell;
  State state;    ///< after its last event; out of date while a group holds it (Bodies::state)
  Flight flight;  ///< free: from that state on
  Ahead ahead;
  std::uint64_t hits = 0;
  int last_wall = -1;
  int hole = -1;
  Fate fate = Fate::survived;
  bool finished = false;
  Time ended;              ///< when, once it is finished
  Group* group = nullptr;  ///< it holds the particle's state; null: free
  std::size_t member = 0;  ///< its number in that group
  Time last_event;         ///< integrated: its last hit or start
  Time check = never;      ///< free: when another particle may be near at the earliest
  std::string report;
  int region = -1;   ///< of the table; -1: outside of all
  Particle outside;  ///< as it is there, of tables with regions
};

/// Bodies are numbered 0 … size-1. Each has one entry in the queue until it has ended.
class Bodies {
 public:
  /// Returns its number. It is due at once, until scheduled.
  int add(Body body);
  void clear();

  int size() const { return static_cast<int>(bodies_.size()); }
  Body& operator[](int i) { return bodies_[static_cast<std::size_t>(i)]; }
  const Body& operator[](int i) const { return bodies_[static_cast<std::size_t>(i)]; }
  /// Throws std::out_of_range.
  const Body& at(int i) const { return bodies_.at(static_cast<std::size_t>(i)); }
  /// After its last event, from its group if it is in one.
  State state(int i) const {
    const Body& b = (*this)[i];
    return b.group == nullptr ? b.state : state_in_group(b);
  }

  /// Has every body ended?
  bool all_ended() const { return queue_.empty(); }
  /// The body to which something happens first.
  int first() const { return queue_.top(); }
  const Time& when(int i) const { return queue_.key(i).time; }
  EventKind what(int i) const { return static_cast<EventKind>(queue_.key(i).kind); }
  void schedule(int i, const Time& when, EventKind kind) {
    queue_.update(i, when, static_cast<int>(kind));
  }

  /// Most hits a body may make.
  void limit_hits(std::uint64_t most) { limit_ = most; }
  bool reaches_limit(const Body& b) const { return b.hits >= limit_; }
  /// Hits that a body may make before the one with which it reaches that.
  std::uint64_t hits_below_limit(const Body& b) const {
    return b.hits + 1 < limit_ ? limit_ - 1 - b.hits : 0;
  }
  /// Counts a hit after which the body has that state, on the wall. `flight_time`: since its last
  /// event.
  const HitEvent& count_hit(int i, Body& b, const State& after, const geometry::Vector& before,
                            double flight_time, int reflections);
  /// The same for one hit of many by the same body, each with one reflection: `expect_hits` first.
  /// `changes_cell`: where a hit may be in another cell than the one before.
  void expect_hits(int i, geometry::Cell cell);
  template <bool changes_cell>
  const HitEvent& count_expected(Body& b, const geometry::Vector& before, double flight_time);
  /// Ends the trajectory of a free body. `why`: for its report.
  void end(int i, Fate fate, Time time, Observer& observer, std::string_view why = {});

 private:
  static State state_in_group(const Body& b);
  const HitEvent& fill_event(const State& after, const geometry::Vector& before,
                             double flight_time);

  std::vector<Body> bodies_;
  EventQueue queue_;
  HitEvent event_;  // kept, and filled in place
  std::uint64_t limit_ = std::numeric_limits<std::uint64_t>::max();
};

/// Number by number, so that no number waits for another.
[[gnu::always_inline]] inline const HitEvent& Bodies::fill_event(const State& after,
                                                                 const geometry::Vector& before,
                                                                 double flight_time) {
  event_.wall = after.wall;
  event_.u = after.u;
  event_.time.high = after.time.high;
  event_.time.low = after.time.low;
  event_.flight_time = flight_time;
  event_.position.x = after.position.x;
  event_.position.y = after.position.y;
  event_.before.x = before.x;
  event_.before.y = before.y;
  event_.after.x = after.velocity.x;
  event_.after.y = after.velocity.y;
  return event_;
}

[[gnu::always_inline]] inline const HitEvent& Bodies::count_hit(int i, Body& b, const State& after,
                                                                const geometry::Vector& before,
                                                                double flight_time,
                                                                int reflections) {
  b.hits += static_cast<std::uint64_t>(reflections);
  b.last_wall = after.wall;
  event_.particle = i;
  event_.reflections = reflections;
  event_.cell.first = after.cell.first;
  event_.cell.second = after.cell.second;
  return fill_event(after, before, flight_time);
}

inline void Bodies::expect_hits(int i, geometry::Cell cell) {
  event_.particle = i;
  event_.cell = cell;
  event_.reflections = 1;
}

template <bool changes_cell>
[[gnu::always_inline]] inline const HitEvent& Bodies::count_expected(Body& b,
                                                                     const geometry::Vector& before,
                                                                     double flight_time) {
  ++b.hits;
  b.last_wall = b.state.wall;
  if constexpr (changes_cell) {
    event_.cell.first = b.state.cell.first;
    event_.cell.second = b.state.cell.second;
  }
  return fill_event(b.state, before, flight_time);
}

}  // namespace carom::events
