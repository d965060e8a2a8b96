// Integration and hand-over: what happens to bodies under forces.
#pragma once

#include <string_view>
#include <vector>

#include "carom/events/dynamics.hpp"
#include "events/bodies.hpp"
#include "events/flight/free_flights.hpp"
#include "events/section_watch.hpp"
#include "events/step/force_regions.hpp"
#include "events/step/groups.hpp"
#include "events/step/neighbours.hpp"

namespace carom::events {

class Integration {
 public:
  Integration(const Table& table, const Dynamics& dynamics, const ForceRegions& regions,
              Bodies& bodies, FreeFlights& flights, Groups& groups, SectionWatch& watch);

  /// A body is to be integrated from its state on.
  void add(int index);
  void clear();

  /// Applies what comes first for a body that does not fly on by itself: it is in a group, or is to
  /// be integrated, or another body may be near.
  void apply(int index, Time now, Observer& observer);
  /// Ends every particle whose step under way failed where that step begins, also if it would end
  /// later than the run. True if others go on from there.
  bool end_failed_steps(Time t_end, Observer& observer);
  /// Reports crossings of the watched surface within steps that go on beyond the end of a run.
  void watch_steps(Time until, Observer& observer);

 private:
  /// A group at the end of its step, or a free body, that looks for neighbours.
  struct Looking {
    Group* group = nullptr;
    int body = -1;
    Time now;
    bool integrated = false;  ///< the body joins a group also if no other is near
  };

  void start(int index, Observer& observer);
  void form(const std::vector<int>& members);
  void join(std::vector<int> members, const Time& now, Observer& observer);

  void settle(Observer& observer);
  void look_around(const Looking& looking, Observer& observer);
  void end_step(Group& group, Observer& observer);
  bool regroup(const Group& group, Observer& observer);
  bool split(const Group& group, Observer& observer);
  bool leave_between_supports(const Group& group, Observer& observer);
  void set_free(int index, Observer& observer);

  void step(Group& group, Observer& observer);
  void give_up(Group& group, Observer& observer);
  void hit(Group& group, std::size_t member, const Barrier<double>& barrier, Observer& observer);
  bool leave_support(Group& group, const Barrier<double>& barrier, Observer& observer);
  void end(int index, Fate fate, const Group& group, Observer& observer, std::string_view why = {});

  const Table& table_;
  const ForceRegions& regions_;
  Bodies& bodies_;
  FreeFlights& flights_;
  Groups& groups_;
  SectionWatch& watch_;
  Neighbours neighbours_;
  std::vector<int> waiting_;      ///< bodies that are to be integrated from their time on
  std::vector<Looking> looking_;  ///< the last one looks first
};

}  // namespace carom::events
