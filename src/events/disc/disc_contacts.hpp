// Hard discs: free flights that end also where two discs touch.
#pragma once

#include <optional>
#include <vector>

#include "base/interrupt.hpp"
#include "carom/events/dynamics.hpp"
#include "carom/table/table.hpp"
#include "events/bodies.hpp"
#include "events/disc/contacts.hpp"
#include "events/flight/free_flights.hpp"
#include "events/section_watch.hpp"

namespace carom::events {

inline bool has_discs(const Dynamics& d) { return d.forces && !d.forces->disc_radii().empty(); }
/// The table as the centres of hard discs see it, or one without walls. Throws InputError where it
/// cannot be built.
Table table_of_discs(const Table& table, const Dynamics& dynamics);

/// All bodies are discs then.
class DiscContacts {
 public:
  DiscContacts(const Table& table, const Dynamics& dynamics, Bodies& bodies, FreeFlights& flights,
               SectionWatch& watch, base::Interrupt& interrupt);

  /// A disc that is to be added: its speed becomes that of its velocity. Throws
  /// std::invalid_argument if it overlaps another.
  void check(const Body& b) const;
  void add(int index);
  void clear();
  /// Finds the contacts of discs that have been added. False if that was interrupted.
  bool begin_run();
  void apply(int index, Observer& observer);

 private:
  /// A disc is at a wall, to rounding.
  struct Touch {
    int wall;
    geometry::Cell cell;
    geometry::PreparedCurve::Frame frame;
    double u;
  };
  void enter(int index, const Time& now);
  void keep_own(int index);
  void look_ahead(int index, const Time& now);
  void look_again(int index, int partner, const Time& now);
  geometry::Cell advance(int index, const Time& now);
  void collide(int finding, Observer& observer);
  void give_up(int index, int other, const Time& now, Observer& observer);
  void start(int index, double way, Observer& observer);
  std::optional<Touch> touched_wall(const State& s, double way) const;
  bool settle_on_wall(int index, double way, Observer& observer);

  const Table& table_;
  const std::vector<double>& radii_;
  Bodies& bodies_;
  FreeFlights& flights_;
  SectionWatch& watch_;
  base::Interrupt& interrupt_;
  Contacts contacts_;
  bool unprepared_ = false;  ///< discs have been added
  Time clock_;               ///< of the last event
  std::vector<int> partners_;
};

}  // namespace carom::events
