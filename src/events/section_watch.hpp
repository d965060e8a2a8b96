// Crossings of the surface that a world watches, in free flight and in integrated motion.
#pragma once

#include <cstddef>
#include <vector>

#include "carom/events/surface.hpp"
#include "carom/table/table.hpp"
#include "events/bodies.hpp"

namespace carom::events {

class Group;

/// Tells an observer of every crossing once. It reads the bodies and changes none.
class SectionWatch {
 public:
  SectionWatch(const Table& table, const Bodies& bodies) : table_(table), bodies_(bodies) {}

  /// Null: nothing is watched, and no other function may be called. `most`: crossings of one
  /// flight.
  void watch(const Surface* surface, std::size_t most);
  bool active() const { return surface_ != nullptr; }

  /// Bodies that have come since the last run are watched from their states on.
  void begin_run();
  /// After an event of the body was applied, or where it goes over between flight and group: not
  /// every body that does so has the event.
  void after_event(int index, Time when, Observer& observer);
  /// The step of a group until a time within it.
  void watch_step(Group& group, Time until, Observer& observer);
  /// Flights that go on beyond the end of a run.
  void watch_flights(Time until, Observer& observer);
  void clear() { seen_.clear(); }

 private:
  /// How far a body's crossings have been reported, and its state there in the plane.
  struct Seen {
    bool begun = false;
    geometry::Vector position, velocity;
    Time time;
    double omega = 0.0;  ///< of the flight from there on
  };
  Seen& seen(int index);
  void watch_flight(int index, Time until, const geometry::Vector* end, Observer& observer);
  void tell(int index, Time start, Observer& observer) const;
  geometry::Vector in_plane(geometry::Vector position, const geometry::Cell& cell) const;

  const Table& table_;
  const Bodies& bodies_;
  const Surface* surface_ = nullptr;
  std::size_t most_ = 0;
  std::vector<Seen> seen_;  ///< one a body
  std::vector<SurfaceCrossing> found_;
};

}  // namespace carom::events
